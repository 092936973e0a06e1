//! Operands made of unit cubes of an integer grid, each with an integer multiplicity: winding numbers and cells are known by looking at cubes.
//! Squares of the grid have one diagonal each, so triangles are the same or meet in vertices and edges.
#![allow(dead_code)]

use super::common::random::Random;
use lapidary::arrangement::{Birth, Operand, Points, Resolved, Soup};
use lapidary::base::{Csr, FaceId, TriangleId, VertexId};
use lapidary::mesh::TriMesh;
use lapidary::mesh::edges::edge_table;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// Per operand the multiplicity of each cube of an n × n × n grid.
pub struct GridCubes {
    pub n: usize,
    pub multiplicity: Vec<Vec<i32>>,
}

/// Vertices and triangles of each operand.
pub type Meshes = Vec<(Vec<[f64; 3]>, Vec<[i32; 3]>)>;

pub fn operands(meshes: &Meshes) -> Vec<Operand<'_>> {
    meshes.iter().map(|(vertices, triangles)| Operand { vertices, triangles }).collect()
}

impl GridCubes {
    pub fn random(random: &mut Random, n: usize, operands: usize, fill: u64, values: &[i32]) -> Self {
        let value = |random: &mut Random| {
            if random.below(100) < fill { values[random.below(values.len() as u64) as usize] } else { 0 }
        };
        let multiplicity = (0..operands).map(|_| (0..n * n * n).map(|_| value(random)).collect()).collect();
        Self { n, multiplicity }
    }

    pub fn cube(&self, x: [usize; 3]) -> usize {
        x[0] + self.n * (x[1] + self.n * x[2])
    }

    /// The vector of a cube; outside of the grid zeros.
    pub fn vector(&self, x: [i64; 3]) -> Vec<i32> {
        let inside = x.iter().all(|&c| 0 <= c && c < self.n as i64);
        self.multiplicity.iter().map(|m| if inside { m[self.cube(x.map(|c| c as usize))] } else { 0 }).collect()
    }

    /// Every cube with multiplicity k as |k| closed meshes, so inner walls are there twice and cancel; coordinates through a linear map.
    pub fn meshes(&self, map: [[f64; 3]; 3]) -> Meshes {
        let at = |x: [usize; 3]| -> [f64; 3] {
            std::array::from_fn(|i| (0..3).map(|k| map[i][k] * x[k] as f64).sum::<f64>())
        };
        self.multiplicity
            .iter()
            .map(|m| {
                let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
                let mut number: HashMap<[usize; 3], i32> = HashMap::new();
                for z in 0..self.n {
                    for y in 0..self.n {
                        for x in 0..self.n {
                            let k = m[self.cube([x, y, z])];
                            for t in cube_triangles([x, y, z]) {
                                let t = if k < 0 { [t[0], t[2], t[1]] } else { t };
                                for _ in 0..k.abs() {
                                    triangles.push(t.map(|p| {
                                        *number.entry(p).or_insert_with(|| {
                                            vertices.push(at(p));
                                            vertices.len() as i32 - 1
                                        })
                                    }));
                                }
                            }
                        }
                    }
                }
                (vertices, triangles)
            })
            .collect()
    }

    /// The regions of equal vectors among cubes that share a square, the outside (a layer around the grid included) being number 0: the region of each cube
    /// of the grid with that layer, and their vectors.
    pub fn regions(&self) -> (HashMap<[i64; 3], usize>, Vec<Vec<i32>>) {
        let n = self.n as i64;
        let mut region: HashMap<[i64; 3], usize> = HashMap::new();
        let mut vectors = Vec::new();
        for z in -1..=n {
            for y in -1..=n {
                for x in -1..=n {
                    if region.contains_key(&[x, y, z]) {
                        continue;
                    }
                    let vector = self.vector([x, y, z]);
                    let mut stack = vec![[x, y, z]];
                    while let Some(c) = stack.pop() {
                        let beyond = c.iter().any(|&k| k < -1 || k > n);
                        if beyond || self.vector(c) != vector || region.contains_key(&c) {
                            continue;
                        }
                        region.insert(c, vectors.len());
                        for axis in 0..3 {
                            for step in [-1, 1] {
                                let mut d = c;
                                d[axis] += step;
                                stack.push(d);
                            }
                        }
                    }
                    vectors.push(vector);
                }
            }
        }
        (region, vectors)
    }
}

/// The boundary of a unit cube, outward; every square is split from its lowest to its highest corner.
fn cube_triangles([x, y, z]: [usize; 3]) -> Vec<[[usize; 3]; 3]> {
    let mut all = Vec::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for high in [false, true] {
            let corner = |a: usize, b: usize| {
                let mut p = [x, y, z];
                p[axis] += high as usize;
                p[u] += a;
                p[v] += b;
                p
            };
            let (p, q, r, s) = (corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
            all.extend(if high { [[p, q, r], [p, r, s]] } else { [[p, r, q], [p, s, r]] });
        }
    }
    all
}

/// The resolved surface of triangles that are equal or meet in vertices and edges. `apart` says of a face whether it is to be behind the whole ones, where
/// parts of cut triangles are; faces with several births are always there.
pub fn resolved(operands: &[Operand], mut apart: impl FnMut() -> bool) -> Resolved {
    let mut number: HashMap<[u64; 3], u32> = HashMap::new();
    let (mut vertices, mut vertex_source, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    let (mut first_triangle, mut source, mut first) = (vec![0], Vec::new(), 0);
    for o in operands {
        for (i, t) in o.triangles.iter().enumerate() {
            triangles.push(t.map(|v| {
                let x = o.vertices[v as usize];
                VertexId(*number.entry(x.map(|c| (c + 0.0).to_bits())).or_insert_with(|| {
                    vertices.push(x);
                    vertex_source.push(first + v as u32);
                    vertices.len() as u32 - 1
                }))
            }));
            source.push(i as u32);
        }
        first_triangle.push(triangles.len() as u32);
        first += o.vertices.len() as u32;
    }
    let table = edge_table(vertices.len(), &triangles);
    let mut bbox = [[0.0; 3]; 2];
    for x in &vertices {
        for i in 0..3 {
            bbox[0][i] = f64::min(bbox[0][i], x[i]);
            bbox[1][i] = f64::max(bbox[1][i], x[i]);
        }
    }
    let mut same: BTreeMap<[VertexId; 3], Vec<TriangleId>> = BTreeMap::new();
    for (t, corners) in triangles.iter().enumerate() {
        let mut sorted = *corners;
        sorted.sort();
        same.entry(sorted).or_default().push(TriangleId::of(t));
    }
    let mut groups: Vec<Vec<TriangleId>> = same.into_values().collect();
    groups.sort();
    let (whole, parts): (Vec<_>, Vec<_>) = groups.into_iter().partition(|g| g.len() == 1 && !apart());
    let turn = |t: TriangleId| {
        let c: [VertexId; 3] = triangles[t.at()];
        let first = (0..3).min_by_key(|&i| c[i]).unwrap();
        c[(first + 1) % 3] < c[(first + 2) % 3]
    };
    let mut r = Resolved { points: Points::default(), whole: whole.len(), ..Resolved::default() };
    r.births = Csr::default();
    for (f, group) in whole.iter().chain(&parts).enumerate() {
        r.faces.push(triangles[group[0].at()]);
        r.support.push(group[0]);
        if group.len() > 1 {
            r.shared.push(FaceId::of(f));
            r.births.items.extend(group.iter().map(|&t| Birth { triangle: t, same: turn(t) == turn(group[0]) }));
            r.births.end_row();
        }
    }
    let mesh = TriMesh {
        vertices,
        vertex_source,
        triangles,
        edges: table.edges,
        triangle_edges: table.triangle_edges,
        edge_uses: table.edge_uses,
        bbox,
        ..TriMesh::default()
    };
    r.soup = Soup { mesh: Arc::new(mesh), first_triangle, source, dropped: vec![0; operands.len()], ..Soup::default() };
    r
}
