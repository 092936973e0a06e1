//! What the integration tests share: readers of polygon files, where optional data lies, and small solids.
#![allow(dead_code)]

pub mod functions;
pub mod icosphere;
pub mod models;
pub mod random;
pub mod shapes;

use lapidary::base::{Culprit, DefectKind, Error, Run};
use lapidary::mesh::{MeshInput, MeshOptions, TriMesh, build};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// A triangle soup with merged vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Soup {
    pub vertices: Vec<[f64; 3]>,
    pub triangles: Vec<[i32; 3]>,
}

/// Polygons over the vertices of a file, before fans and merging.
#[derive(Default)]
struct Polygons {
    vertices: Vec<[f64; 3]>,
    corners: Vec<i32>,
    starts: Vec<usize>,
}

impl Polygons {
    /// Fans from the first listed corner; vertices with equal coordinates (−0 equals +0) become one, numbered by first
    /// occurrence. No face is dropped.
    fn soup(self) -> Soup {
        let mut soup = Soup::default();
        let mut numbers: HashMap<[u64; 3], i32> = HashMap::new();
        let mut number = Vec::with_capacity(self.vertices.len());
        for x in self.vertices {
            let x = x.map(|c| c + 0.0);
            let next = soup.vertices.len() as i32;
            let n = *numbers.entry(x.map(f64::to_bits)).or_insert(next);
            if n == next {
                soup.vertices.push(x);
            }
            number.push(n);
        }
        let corner = |i: i32| number.get(i as usize).copied().unwrap_or(i);
        for (f, &start) in self.starts.iter().enumerate() {
            let end = self.starts.get(f + 1).copied().unwrap_or(self.corners.len());
            let polygon = &self.corners[start..end];
            for k in 2..polygon.len() {
                soup.triangles.push([corner(polygon[0]), corner(polygon[k - 1]), corner(polygon[k])]);
            }
        }
        soup
    }
}

fn number<T: std::str::FromStr>(token: Option<&str>, what: &str) -> Result<T, String> {
    let token = token.ok_or_else(|| format!("{what} is missing"))?;
    token.parse().map_err(|_| format!("{what}: {token:?} is not a number"))
}

/// Reads OFF text: OFF, COFF, NOFF, CNOFF, STOFF...; `#` comments anywhere; numbers after the coordinates or the corners
/// of a line (normals, colours) are skipped. Coordinates are correctly rounded.
pub fn parse_off(text: &str) -> Result<Soup, String> {
    let mut lines = text.lines().map(|l| l.split('#').next().unwrap_or("").trim()).filter(|l| !l.is_empty());
    let mut counts = lines.next().ok_or("the file is empty")?;
    if let Some((head, rest)) = counts.split_once("OFF") {
        if !head.chars().all(|c| "STCN".contains(c)) {
            return Err(format!("{head}OFF is not a header"));
        }
        counts = if rest.trim().is_empty() { lines.next().ok_or("the counts are missing")? } else { rest };
    }
    let mut counts = counts.split_whitespace();
    let vertex_count: usize = number(counts.next(), "the number of vertices")?;
    let face_count: usize = number(counts.next(), "the number of faces")?;
    let mut polygons = Polygons::default();
    for i in 0..vertex_count {
        let mut tokens = lines.next().ok_or_else(|| format!("vertex {i} is missing"))?.split_whitespace();
        let mut x = [0.0; 3];
        for c in &mut x {
            *c = number(tokens.next(), "a coordinate")?;
        }
        polygons.vertices.push(x);
    }
    for i in 0..face_count {
        let mut tokens = lines.next().ok_or_else(|| format!("face {i} is missing"))?.split_whitespace();
        let n: usize = number(tokens.next(), "the number of corners")?;
        polygons.starts.push(polygons.corners.len());
        for _ in 0..n {
            polygons.corners.push(number(tokens.next(), "a corner")?);
        }
    }
    Ok(polygons.soup())
}

/// Reads OBJ text: `v` and `f` lines; indices from 1, or from the end when negative; `/…` after an index is skipped.
pub fn parse_obj(text: &str) -> Result<Soup, String> {
    let mut polygons = Polygons::default();
    for line in text.lines() {
        let mut tokens = line.split('#').next().unwrap_or("").split_whitespace();
        match tokens.next() {
            Some("v") => {
                let mut x = [0.0; 3];
                for c in &mut x {
                    *c = number(tokens.next(), "a coordinate")?;
                }
                polygons.vertices.push(x);
            }
            Some("f") => {
                polygons.starts.push(polygons.corners.len());
                for token in tokens {
                    let i: i32 = number(token.split('/').next(), "a corner")?;
                    polygons.corners.push(if i < 0 { polygons.vertices.len() as i32 + i } else { i - 1 });
                }
            }
            _ => {}
        }
    }
    Ok(polygons.soup())
}

pub fn read_off(path: &Path) -> Result<Soup, String> {
    parse_off(&read_text(path)?).map_err(|e| format!("{}: {e}", path.display()))
}

/// Reads binary STL: a triangle is a normal, three corners (32-bit floats) and two bytes.
pub fn read_stl(path: &Path) -> Result<Soup, String> {
    let bytes = std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let count = bytes.get(80..84).map(|b| u32::from_le_bytes(b.try_into().unwrap()) as usize).unwrap_or(usize::MAX);
    if bytes.len() != count.saturating_mul(50).saturating_add(84) {
        return Err(format!("{}: not binary STL", path.display()));
    }
    let mut polygons = Polygons::default();
    for triangle in bytes[84..].chunks_exact(50) {
        polygons.starts.push(polygons.corners.len());
        for corner in triangle[12..48].chunks_exact(12) {
            let x = |i: usize| f64::from(f32::from_le_bytes(corner[4 * i..4 * i + 4].try_into().unwrap()));
            polygons.corners.push(polygons.vertices.len() as i32);
            polygons.vertices.push([x(0), x(1), x(2)]);
        }
    }
    Ok(polygons.soup())
}

/// Reads OFF, OBJ or STL by the file's ending.
pub fn read_mesh(path: &Path) -> Result<Soup, String> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("obj") => read_obj(path),
        Some("stl") => read_stl(path),
        _ => read_off(path),
    }
}

pub fn read_obj(path: &Path) -> Result<Soup, String> {
    parse_obj(&read_text(path)?).map_err(|e| format!("{}: {e}", path.display()))
}

/// Comments may be in any encoding.
fn read_text(path: &Path) -> Result<String, String> {
    let bytes = std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// A file of the shared data: below `LAPIDARY_SHARED`, or `../shared`. `None`, with the reason printed, if it is not there.
pub fn shared(file: &str) -> Option<PathBuf> {
    let base = std::env::var_os("LAPIDARY_SHARED").map(PathBuf::from);
    let base = base.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"));
    let path = base.join(file);
    if path.exists() {
        return Some(path);
    }
    println!("skipped: {} does not exist (set LAPIDARY_SHARED)", path.display());
    None
}

/// The directory of CGAL's meshes, from `LAPIDARY_CGAL_MESHES`. `None`, with the reason printed, if it is not set.
pub fn cgal_meshes() -> Option<PathBuf> {
    let path = std::env::var_os("LAPIDARY_CGAL_MESHES").map(PathBuf::from);
    if path.is_none() {
        println!("skipped: LAPIDARY_CGAL_MESHES is not set");
    }
    path
}

pub fn build_soup(soup: &Soup, options: MeshOptions) -> Result<TriMesh, Error> {
    let input = MeshInput { vertices: &soup.vertices, triangles: &soup.triangles, tags: None };
    build(&input, &options, &mut Run::quiet())
}

/// The defects of a mesh that must have some.
pub fn defects(soup: &Soup, options: MeshOptions) -> Vec<Culprit> {
    build_soup(soup, options).expect_err("the mesh has defects").culprits
}

pub fn culprit(kind: DefectKind, ids: &[i64]) -> Culprit {
    Culprit::new(kind, ids)
}

/// An axis-parallel box of 12 triangles, facing outward.
pub fn cuboid(lo: [f64; 3], hi: [f64; 3]) -> Soup {
    let corner = |i: usize| std::array::from_fn(|k| if i >> k & 1 == 0 { lo[k] } else { hi[k] });
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Soup {
        vertices: (0..8).map(corner).collect(),
        triangles: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
    }
}

pub fn cube(lo: f64, hi: f64) -> Soup {
    cuboid([lo; 3], [hi; 3])
}

/// A tetrahedron on four points, facing outward if they are positively oriented: (b−a)×(c−a)·(d−a) > 0.
pub fn tetrahedron(points: [[f64; 3]; 4]) -> Soup {
    Soup { vertices: points.to_vec(), triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] }
}

/// The same surface facing the other way.
pub fn flipped(mut soup: Soup) -> Soup {
    for t in &mut soup.triangles {
        t.swap(1, 2);
    }
    soup
}

/// All in one, nothing merged.
pub fn together(parts: &[Soup]) -> Soup {
    let mut all = Soup::default();
    for part in parts {
        let base = all.vertices.len() as i32;
        all.vertices.extend(&part.vertices);
        all.triangles.extend(part.triangles.iter().map(|t| t.map(|i| i + base)));
    }
    all
}

pub fn merging() -> MeshOptions {
    MeshOptions { merge_duplicate_vertices: true, ..Default::default() }
}

pub fn checking() -> MeshOptions {
    MeshOptions { check_self_intersection: true, ..Default::default() }
}
