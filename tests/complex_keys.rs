//! Keys: no two vertices and no two faces of a complex share one; they stay with their vertices and faces when vertices,
//! triangles and planes are renumbered with their global ids carried along, and in blocks that know only a part of the planes
//! and triangles.
//!
//! Small cases and small models by default; all models with `LAPIDARY_ALL=1`.

mod common;

use common::Soup;
use common::models::{arbitrary, each_model, grid, incident, on_integers, permutation, small_cases};
use common::random::Random;
use lapidary::base::{EdgeId, Error, FaceId, PlaneId, Run, Status, TriangleId, VertexId};
use lapidary::complex::keys::{Corner, face_key, face_keys, names, vertex_key, vertex_keys};
use lapidary::complex::{Complex, GlobalIds, Key, Origin, SupportId};
use lapidary::cut::{Cut, CutOptions, cut};
use lapidary::exact::Plane;
use lapidary::grid::{GridOptions, Lattice, cut_grid};
use lapidary::mesh::{TriMesh, edges::edge_table};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Keys of vertices and of faces.
fn keys(c: &Complex, ids: &GlobalIds) -> Result<(Vec<Key>, Vec<Key>), Error> {
    let names = names(&c.mesh, &c.planes, ids)?;
    Ok((vertex_keys(c, &names), face_keys(c, &names)?))
}

/// A complex told by keys alone: coordinates of each vertex, and edges of each face.
#[derive(PartialEq)]
struct Told {
    vertices: BTreeMap<Key, [u64; 3]>,
    faces: BTreeMap<Key, Vec<[Key; 2]>>,
}

fn told(what: &str, c: &Complex, ids: &GlobalIds) -> Told {
    let (of_vertex, of_face) = keys(c, ids).unwrap();
    let told = Told {
        vertices: of_vertex.iter().zip(&c.coords).map(|(k, x)| (*k, x.map(f64::to_bits))).collect(),
        faces: of_face.iter().enumerate().map(|(f, k)| (*k, face_edges(c, FaceId::of(f), &of_vertex))).collect(),
    };
    assert_eq!(told.vertices.len(), c.vertex_count(), "{what}: two vertices with one key");
    assert_eq!(told.faces.len(), c.face_count(), "{what}: two faces with one key");
    assert!(told.vertices.keys().chain(told.faces.keys()).all(|k| k.0[0] >= 0), "{what}: a negative key");
    assert!(told.vertices.keys().all(|k| !told.faces.contains_key(k)), "{what}: a vertex with the key of a face");
    told
}

/// The edges of a face, each with its ends in order, sorted.
fn face_edges(c: &Complex, f: FaceId, of_vertex: &[Key]) -> Vec<[Key; 2]> {
    let mut edges: Vec<[Key; 2]> = Vec::new();
    for l in c.loops_of(f) {
        let corners = &c.corner_vertices[c.corners_of(l)];
        for (i, v) in corners.iter().enumerate() {
            let mut ends = [*v, corners[(i + 1) % corners.len()]].map(|v| of_vertex[v.at()]);
            ends.sort();
            edges.push(ends);
        }
    }
    edges.sort();
    edges
}

fn same(what: &str, a: &Told, b: &Told) {
    assert!(a.vertices == b.vertices, "{what}: other keys of vertices");
    assert!(a.faces == b.faces, "{what}: other keys of faces");
}

/// Distinct ids, neither rising nor close together, up to the largest one allowed.
fn scattered(n: usize, seed: u64) -> Vec<i64> {
    let stride = (1i64 << 40) / n.max(1) as i64;
    permutation(n, seed).iter().map(|&i| (1 << 40) - 1 - i as i64 * stride).collect()
}

fn run(soup: &Soup, planes: &[Plane]) -> Cut {
    let mesh = Arc::new(common::build_soup(soup, Default::default()).unwrap());
    cut(&mesh, planes, &CutOptions::default(), &mut Run::quiet()).unwrap()
}

/// The same input in other orders: element `i` of the new arrays is `order[i]` of the old ones.
fn reordered(soup: &Soup, of_vertices: &[usize], of_triangles: &[usize]) -> Soup {
    let mut inverse = vec![0; of_vertices.len()];
    of_vertices.iter().enumerate().for_each(|(new, &old)| inverse[old] = new as i32);
    Soup {
        vertices: of_vertices.iter().map(|&v| soup.vertices[v]).collect(),
        triangles: of_triangles.iter().map(|&t| soup.triangles[t].map(|v| inverse[v as usize])).collect(),
    }
}

/// All that may not change the keys of one input.
fn check_renumbered(what: &str, soup: &Soup, planes: &[Plane]) {
    let (n_triangles, n_planes) = (soup.triangles.len(), planes.len());
    let plain = run(soup, planes);
    // Positions are ids if nothing else is said, and then the order of planes is the order of their names.
    let own: Vec<i64> = (0..n_triangles.max(n_planes) as i64).collect();
    let base = told(what, &plain.complex, &GlobalIds::default());
    let said = GlobalIds { triangles: Some(&own[..n_triangles]), planes: Some(&own[..n_planes]), plane_map: None };
    same(&format!("{what}: positions as ids"), &told(what, &plain.complex, &said), &base);

    let (of_triangles, of_planes) = (scattered(n_triangles, 5), scattered(n_planes, 6));
    let ids = GlobalIds { triangles: Some(&of_triangles), planes: Some(&of_planes), plane_map: Some(&plain.plane_map) };
    let base = told(what, &plain.complex, &ids);
    let keep = |n: usize| (0..n).collect::<Vec<usize>>();
    let (v, t, p) = (permutation(soup.vertices.len(), 1), permutation(n_triangles, 2), permutation(n_planes, 3));
    let orders = [
        ("vertices", &v, &keep(n_triangles), &keep(n_planes)),
        ("triangles", &keep(soup.vertices.len()), &t, &keep(n_planes)),
        ("planes", &keep(soup.vertices.len()), &keep(n_triangles), &p),
        ("all", &v, &t, &p),
    ];
    for (which, v, t, p) in orders {
        let other_planes: Vec<Plane> = p.iter().map(|&i| planes[i]).collect();
        let other = run(&reordered(soup, v, t), &other_planes);
        let of_triangles: Vec<i64> = t.iter().map(|&i| of_triangles[i]).collect();
        let of_planes: Vec<i64> = p.iter().map(|&i| of_planes[i]).collect();
        let ids =
            GlobalIds { triangles: Some(&of_triangles), planes: Some(&of_planes), plane_map: Some(&other.plane_map) };
        let what = format!("{what}: {which} renumbered");
        same(&what, &told(&what, &other.complex, &ids), &base);
    }
}

/// A box of grid planes: for each axis the first and the last plane's position along it.
type Block = [[usize; 2]; 3];

/// The faces with all vertices in the block, and those vertices.
fn inside(c: &Complex, box_: [[f64; 3]; 2]) -> (Vec<bool>, Vec<FaceId>) {
    let [low, high] = box_;
    let in_box = |x: &[f64; 3]| (0..3).all(|a| low[a] <= x[a] && x[a] <= high[a]);
    let vertices: Vec<bool> = c.coords.iter().map(in_box).collect();
    let whole = |f: &FaceId| c.corner_vertices[c.face_corners(*f)].iter().all(|v| vertices[v.at()]);
    let faces = (0..c.face_count()).map(FaceId::of).filter(whole).collect();
    (vertices, faces)
}

/// A block as a rank would hold it: only the triangles that meet its closed box, in another order. With the old
/// triangle of each new one.
fn part(mesh: &TriMesh, keep: &[bool]) -> (TriMesh, Vec<TriangleId>) {
    let mut kept: Vec<TriangleId> = (0..keep.len()).filter(|&t| keep[t]).map(TriangleId::of).collect();
    let order = permutation(kept.len(), 7);
    kept = order.iter().map(|&i| kept[i]).collect();
    let mut number = vec![VertexId::NONE; mesh.vertices.len()];
    let mut part = TriMesh::default();
    for t in &kept {
        let corners = mesh.triangles[t.at()].map(|v| {
            if number[v.at()].is_none() {
                number[v.at()] = VertexId::of(part.vertices.len());
                part.vertices.push(mesh.vertices[v.at()]);
                part.vertex_source.push(v.0);
            }
            number[v.at()]
        });
        part.triangles.push(corners);
    }
    let table = edge_table(part.vertices.len(), &part.triangles);
    (part.edges, part.triangle_edges, part.edge_uses) = (table.edges, table.triangle_edges, table.edge_uses);
    (part, kept)
}

/// Cuts by the planes of the block alone, with the triangles that touch the block alone, give the keys of the whole.
fn check_block(what: &str, mesh: &Arc<TriMesh>, n: usize, block: Block) {
    let planes = grid(mesh, n);
    let whole = cut(mesh, &planes, &CutOptions::default(), &mut Run::quiet()).unwrap().complex;
    let at = |a: usize, end: usize| a * n + block[a][end];
    let corner = |end: usize| std::array::from_fn(|a| -planes[at(a, end)].d);
    let box_ = [corner(0), corner(1)];
    let ids: Vec<i64> = (0..3).flat_map(|a| at(a, 0) as i64..=at(a, 1) as i64).collect();
    let own_planes: Vec<Plane> = ids.iter().map(|&i| planes[i as usize]).collect();
    let own = cut(mesh, &own_planes, &CutOptions::default(), &mut Run::quiet()).unwrap().complex;
    let (of_vertex, of_face) = keys(&own, &GlobalIds { planes: Some(&ids), ..Default::default() }).unwrap();
    let (all_vertices, all_faces) = keys(&whole, &GlobalIds::default()).unwrap();
    let told = |c: &Complex, faces: &[FaceId], v: &[Key], f: &[Key]| -> BTreeMap<Key, Vec<[Key; 2]>> {
        faces.iter().map(|face| (f[face.at()], face_edges(c, *face, v))).collect()
    };
    let ((own_in, own_faces), (_, whole_faces)) = (inside(&own, box_), inside(&whole, box_));
    let known = told(&whole, &whole_faces, &all_vertices, &all_faces);
    assert!(told(&own, &own_faces, &of_vertex, &of_face) == known, "{what}: other keys with a part of the planes");

    // A triangle that meets the closed box has a vertex of the complex in it.
    let mut keep = vec![false; mesh.triangles.len()];
    for f in (0..own.face_count()).map(FaceId::of) {
        if let SupportId::Triangle(t) = own.face_support[f.at()] {
            keep[t.at()] |= own.corner_vertices[own.face_corners(f)].iter().any(|v| own_in[v.at()]);
        }
    }
    let (part, old) = part(mesh, &keep);
    let of_triangles: Vec<i64> = old.iter().map(|t| t.0.into()).collect();
    let new_triangle = |t: TriangleId| TriangleId::of(old.iter().position(|o| *o == t).unwrap());
    let new_vertex = |v: VertexId| VertexId::of(part.vertex_source.iter().position(|s| *s == v.0).unwrap());
    let new_edge = |e: EdgeId| {
        let mut ends = mesh.edges[e.at()].map(new_vertex);
        ends.sort();
        EdgeId::of(part.edges.binary_search(&ends).unwrap())
    };
    let origin = |v: VertexId| match own.origins[v.at()] {
        Origin::Mesh(m) => Origin::Mesh(new_vertex(m)),
        Origin::Edge(e, p) => Origin::Edge(new_edge(e), p),
        Origin::Triangle(t, p, q) => Origin::Triangle(new_triangle(t), p, q),
        inner => inner,
    };
    let ids = GlobalIds { triangles: Some(&of_triangles), planes: Some(&ids), plane_map: None };
    let names = names(&part, &own_planes, &ids).unwrap();
    let corners: Vec<Option<Corner<&[PlaneId]>>> = (0..own.vertex_count())
        .map(VertexId::of)
        .map(|v| own_in[v.at()].then(|| Corner { origin: origin(v), planes: own.vertex_planes.row(v) }))
        .collect();
    for (v, corner) in corners.iter().enumerate() {
        if let Some(corner) = corner {
            assert_eq!(vertex_key(&names, corner), of_vertex[v], "{what}: vertex {v} with a part of the triangles");
        }
    }
    for f in own_faces {
        let support = match own.face_support[f.at()] {
            SupportId::Triangle(t) => SupportId::Triangle(new_triangle(t)),
            plane => plane,
        };
        let loops = own.loops_of(f).map(|l| &own.corner_vertices[own.corners_of(l)]);
        let key = face_key(&names, support, loops, |v| corners[v.at()].unwrap());
        assert_eq!(key, Some(of_face[f.at()]), "{what}: face {} with a part of the triangles", f.0);
    }
}

#[test]
fn small_cases_renumbered() {
    for case in small_cases() {
        check_renumbered(&case.name, &case.soup, &case.planes);
    }
}

/// Coincident planes that face either way and have their smallest id anywhere.
#[test]
fn coincident_planes() {
    for case in small_cases() {
        let planes: Vec<Plane> = case
            .planes
            .iter()
            .flat_map(|p| [-2.0, 1.0, 0.5, -1.0].map(|s| Plane { n: p.n.map(|n| n * s), d: p.d * s }))
            .collect();
        check_renumbered(&format!("{} with coincident planes", case.name), &case.soup, &planes);
    }
}

/// Pencils: every edge of the sections lies in several planes.
#[test]
fn pencils() {
    let soup = common::together(&[common::cube(-1.0, 1.0), common::flipped(common::cube(-0.5, 0.5))]);
    let star: Vec<Plane> = (0..6)
        .map(|i| Plane { n: [(i - 2) as f64, (3 - i) as f64 * 0.5, 0.0], d: 0.0 })
        .chain((0..5).map(|i| Plane { n: [0.0, i as f64 - 2.0, 1.0], d: 0.0 }))
        .chain([Plane { n: [1.0, 1.0, 1.0], d: 0.0 }, Plane { n: [1.0, 0.0, 0.0], d: -1.0 }])
        .collect();
    check_renumbered("pencils", &soup, &star);
}

#[test]
fn models() {
    let mut cuts = 0;
    let there = each_model(1000, |name, soup, mesh| {
        let mut random = Random(soup.triangles.len() as u64);
        let check = |what: &str, mesh: &TriMesh, planes: &[Plane]| {
            let soup = Soup {
                vertices: mesh.vertices.clone(),
                triangles: mesh.triangles.iter().map(|t| t.map(|v| v.0 as i32)).collect(),
            };
            check_renumbered(&format!("{name} {what}"), &soup, planes);
        };
        check("A5", &mesh, &grid(&mesh, 5));
        check("A10", &mesh, &grid(&mesh, 10));
        check("R30", &mesh, &arbitrary(&mesh, 30, &mut random));
        check("incident", &mesh, &incident(&mesh, 6, &mut random));
        if let Some(mesh) = on_integers(soup) {
            check("integers", &mesh, &incident(&mesh, 8, &mut random));
        }
        // Distinct at least, under every kind of plane set.
        for (what, planes) in [
            ("R10", arbitrary(&mesh, 10, &mut random)),
            ("R100", arbitrary(&mesh, 100, &mut random)),
            ("box", grid(&mesh, 2)),
        ] {
            let made = cut(&mesh, &planes, &CutOptions::default(), &mut Run::quiet()).unwrap();
            told(&format!("{name} {what}"), &made.complex, &GlobalIds::default());
        }
        cuts += 7;
    });
    assert!(!there || cuts > 70, "{cuts} cuts");
}

#[test]
fn blocks() {
    let block = [[1, 3], [0, 2], [2, 4]];
    for case in small_cases() {
        let mesh = Arc::new(common::build_soup(&case.soup, Default::default()).unwrap());
        check_block(&case.name, &mesh, 5, block);
        check_block(&case.name, &mesh, 6, [[0, 5], [1, 2], [2, 3]]);
    }
    each_model(1000, |name, _, mesh| {
        if mesh.triangles.len() < 5000 {
            check_block(name, &mesh, 5, block);
        }
    });
}

/// The cells of a grid's block are made by other means than a cut's: what they are made of has the same keys.
fn check_grid(what: &str, mesh: &Arc<TriMesh>) {
    let [low, high] = mesh.bbox;
    let nodes: [Vec<f64>; 3] = std::array::from_fn(|a| {
        // Planes on the bounding box and through vertices.
        let mut nodes: Vec<f64> = mesh.vertices.iter().step_by(mesh.vertices.len() / 5 + 1).map(|x| x[a]).collect();
        nodes.extend([low[a], high[a], low[a] + 0.3 * (high[a] - low[a])]);
        nodes.sort_by(f64::total_cmp);
        nodes.dedup();
        nodes
    });
    let n = [&nodes[0][..], &nodes[1][..], &nodes[2][..]];
    let lattice = Lattice::new(n, [0; 3], [0, 1, 2].map(|a| nodes[a].len() as i64 - 1)).unwrap();
    let grid = cut_grid(mesh, lattice, &GridOptions::default(), &mut Run::quiet()).unwrap();
    let general = cut(mesh, &grid.planes, &CutOptions::default(), &mut Run::quiet()).unwrap().complex;
    let known = told(what, &general, &GlobalIds::default());
    let (of_vertex, of_face) = lapidary::grid::keys(&grid, None).unwrap();
    for (v, key) in of_vertex.iter().enumerate() {
        assert_eq!(known.vertices.get(key), Some(&grid.coords[v].map(f64::to_bits)), "{what}: vertex {v}");
    }
    let own = lapidary::grid::to_complex(&grid);
    for (f, key) in of_face.iter().enumerate() {
        let edges = face_edges(&own, FaceId::of(f), &of_vertex);
        assert!(known.faces.get(key) == Some(&edges), "{what}: face {f}");
    }
}

#[test]
fn grids() {
    for case in small_cases() {
        check_grid(&case.name, &Arc::new(common::build_soup(&case.soup, Default::default()).unwrap()));
    }
    each_model(3000, |name, _, mesh| check_grid(name, &mesh));
}

/// The layout of keys is part of the interface: ranks may run different builds.
#[test]
fn layout() {
    let planes = [Plane { n: [1.0, 0.0, 0.0], d: 0.0 }, Plane { n: [0.0, 1.0, 0.0], d: 0.0 }];
    let made = run(&common::cube(-1.0, 1.0), &planes).complex;
    let (of_vertex, of_face) = keys(&made, &GlobalIds::default()).unwrap();
    let unpack = |k: Key| {
        let bits = (k.0[0] as u64 as u128) << 64 | k.0[1] as u64 as u128;
        let id = |shift: u32| (bits >> shift) as u64 & ((1 << 40) - 1);
        ((bits >> 120) as u32, [id(80), id(40), id(0)])
    };
    for (v, key) in of_vertex.iter().enumerate() {
        let (tag, ids) = unpack(*key);
        let smallest = |wanted: &dyn Fn(usize, usize) -> bool| {
            let all = (0..made.mesh.triangles.len()).flat_map(|t| (0..3).map(move |k| (t, k)));
            all.clone().find(|&(t, k)| wanted(t, k)).map(|(t, k)| (t as u64, k as u32)).unwrap()
        };
        let expected = match made.origins[v] {
            Origin::Mesh(m) => {
                let (t, k) = smallest(&|t, k| made.mesh.triangles[t][k] == m);
                (k, [t, 0, 0])
            }
            Origin::Edge(e, p) => {
                let (t, k) = smallest(&|t, k| made.mesh.triangle_edges[t][k] == e);
                (3 + k, [t, p.0.into(), 0])
            }
            Origin::Triangle(t, p, q) => (6, [t.0.into(), p.0.into(), q.0.into()]),
            Origin::Planes(p, q, r) => (7, [p, q, r].map(|p| p.0.into())),
            other => unreachable!("a cut's vertex {other:?}"),
        };
        assert_eq!((tag, ids), expected, "vertex {v}");
    }
    // Every face on a plane has a piece of the line of both planes, or a chord whose start is on a second plane.
    for (f, key) in of_face.iter().enumerate() {
        let (tag, ids) = unpack(*key);
        match made.face_support[f] {
            SupportId::Triangle(t) => assert!((8..12).contains(&tag) || (44..56).contains(&tag), "{tag} {t:?}"),
            SupportId::Plane(p) => {
                assert!((12..44).contains(&tag) || (56..92).contains(&tag), "face {f}: {tag}");
                assert_eq!(ids[0], u64::from(p.0));
            }
            SupportId::Level(_) => unreachable!("a level in a cut by planes"),
        }
    }
    assert!(of_face.iter().any(|k| (16..32).contains(&unpack(*k).0)));
}

#[test]
fn ids_that_are_none() {
    let made = run(&common::cube(-1.0, 1.0), &[Plane { n: [1.0, 0.0, 0.0], d: 0.0 }]).complex;
    let refuse = |ids: GlobalIds, named: &str| {
        let error = keys(&made, &ids).unwrap_err();
        assert_eq!(error.status, Status::BadArgument);
        assert_eq!(error.message, named);
    };
    let ids: Vec<i64> = (0..12).collect();
    let with = |i: usize, id: i64| {
        let mut ids = ids.clone();
        ids[i] = id;
        ids
    };
    refuse(GlobalIds { triangles: Some(&ids[1..]), ..Default::default() }, "11 ids for 12 triangles");
    let out = with(3, -1);
    refuse(GlobalIds { triangles: Some(&out), ..Default::default() }, "the id of triangle 3, -1, is not in 0..2^40");
    let out = with(4, 1 << 40);
    refuse(
        GlobalIds { triangles: Some(&out), ..Default::default() },
        "the id of triangle 4, 1099511627776, is not in 0..2^40",
    );
    let twice = with(7, 2);
    refuse(GlobalIds { triangles: Some(&twice), ..Default::default() }, "triangles 2 and 7 have the same id, 2");
    refuse(GlobalIds { planes: Some(&[]), ..Default::default() }, "0 ids for 1 planes");
    keys(&made, &GlobalIds { triangles: Some(&with(11, (1 << 40) - 1)), ..Default::default() }).unwrap();
}
