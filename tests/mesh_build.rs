//! Building a mesh, and every defect with its culprits.

mod common;
use common::*;
use lapidary::base::{DefectKind, DefectKind::*, Run, Status, VertexId};
use lapidary::mesh::{MeshInput, MeshOptions, build, edges};

fn plain() -> MeshOptions {
    MeshOptions::default()
}

#[test]
fn a_cube() {
    let soup = cube(0.0, 1.0);
    let mesh = build_soup(&soup, checking()).unwrap();
    mesh.check().unwrap();
    assert_eq!((mesh.vertices.len(), mesh.edges.len(), mesh.triangles.len()), (8, 18, 12));
    assert_eq!((mesh.shells.len(), mesh.component_count), (1, 1));
    assert!(mesh.shells[0].outer && mesh.shells[0].anchor.is_none());
    assert_eq!(mesh.bbox, [[0.0; 3], [1.0; 3]]);
    assert_eq!(mesh.vertex_source, (0..8).collect::<Vec<u32>>());
}

#[test]
fn unused_vertices_are_dropped_and_minus_zero_is_zero() {
    let mut soup = cube(0.0, 1.0);
    for x in soup.vertices.iter_mut().flatten().filter(|x| **x == 0.0) {
        *x = -0.0;
    }
    // Unused vertices in front, in the middle and at the end, two of them equal to used ones.
    soup.vertices.insert(0, [9.0; 3]);
    soup.vertices.insert(4, [1.0; 3]);
    soup.vertices.push([0.0; 3]);
    for i in soup.triangles.iter_mut().flatten() {
        *i += if *i < 3 { 1 } else { 2 };
    }
    let mesh = build_soup(&soup, plain()).unwrap();
    mesh.check().unwrap();
    assert_eq!(mesh.vertex_source, [1, 2, 3, 5, 6, 7, 8, 9]);
    assert!(mesh.vertices.iter().flatten().all(|x| x.to_bits() == 0 || *x == 1.0));
    assert!(mesh.bbox[0].iter().all(|x| x.to_bits() == 0));
}

#[test]
fn tags_are_kept() {
    let soup = cube(0.0, 1.0);
    let tags: Vec<i32> = (0..12).map(|i| i / 2 - 3).collect();
    let input = MeshInput { vertices: &soup.vertices, triangles: &soup.triangles, tags: Some(&tags) };
    assert_eq!(build(&input, &plain(), &mut Run::quiet()).unwrap().tags, tags);
    let short = MeshInput { tags: Some(&tags[1..]), ..input };
    assert_eq!(build(&short, &plain(), &mut Run::quiet()).unwrap_err().status, Status::BadArgument);
}

#[test]
fn cancelling_at_every_stage() {
    let soup = together(&[cube(0.0, 1.0), cube(2.0, 3.0)]);
    let input = MeshInput { vertices: &soup.vertices, triangles: &soup.triangles, tags: None };
    let mut stages = 0;
    let mut count = |_: &'static str, fraction: f64| {
        assert!((0.0..=1.0).contains(&fraction));
        stages += 1;
        true
    };
    build(&input, &checking(), &mut Run::new(Some(&mut count), None)).unwrap();
    assert_eq!(stages, 5);
    for stop in 0..stages {
        let mut seen = 0;
        let mut cancel = |_: &'static str, _: f64| {
            seen += 1;
            seen <= stop
        };
        let error = build(&input, &checking(), &mut Run::new(Some(&mut cancel), None)).unwrap_err();
        assert_eq!(error.status, Status::Cancelled);
    }
}

#[test]
fn empty() {
    let error = build_soup(&Soup::default(), plain()).unwrap_err();
    assert_eq!(error.status, Status::BadMesh);
    assert_eq!(error.culprits, [culprit(Empty, &[])]);
    assert!(error.message.contains("no triangles"));
}

#[test]
fn not_finite() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut soup = cube(0.0, 1.0);
        soup.vertices[5][1] = bad;
        let error = build_soup(&soup, checking()).unwrap_err();
        assert_eq!(error.culprits, [culprit(NonFiniteCoordinate, &[5])]);
        assert_eq!(error.message, "vertex 5 has a coordinate that is not finite");
        // Two of them are no duplicates, and unused ones count as well.
        soup.vertices[2] = soup.vertices[5];
        soup.vertices.push([bad; 3]);
        let expected = [2, 5, 8].map(|v| culprit(NonFiniteCoordinate, &[v]));
        assert_eq!(defects(&soup, checking()), expected);
    }
}

#[test]
fn index_out_of_range() {
    for bad in [8, -1, i32::MIN, i32::MAX] {
        let mut soup = cube(0.0, 1.0);
        let whole = soup.triangles[7];
        soup.triangles[7][1] = bad;
        let error = build_soup(&soup, checking()).unwrap_err();
        // The edges of the broken triangle are not called open.
        assert_eq!(error.culprits, [culprit(IndexOutOfRange, &[7, 1, bad as i64])]);
        assert!(error.message.contains("corner 1 of triangle 7"), "{}", error.message);
        soup.triangles[7] = [bad, whole[1], bad];
        let expected = [0, 2].map(|k| culprit(IndexOutOfRange, &[7, k, bad as i64]));
        assert_eq!(defects(&soup, checking()), expected);
        soup.triangles = vec![[bad; 3]; 2];
        assert_eq!(defects(&soup, checking()).len(), 6);
    }
}

#[test]
fn open_edges_far_from_a_broken_triangle_are_named() {
    let mut soup = together(&[cube(0.0, 1.0), cube(2.0, 3.0)]);
    soup.triangles[3][2] = 99;
    soup.triangles.remove(12);
    // Triangle 12 was (8, 10, 11); each of its neighbours is left alone on an edge.
    let found = defects(&soup, plain());
    assert_eq!(found[0], culprit(IndexOutOfRange, &[3, 2, 99]));
    let open: Vec<[i64; 2]> =
        found[1..].iter().map(|c| (c.kind == OpenEdge).then_some([c.ids[0], c.ids[1]]).unwrap()).collect();
    assert_eq!(open, [[8, 10], [8, 11], [10, 11]]);
}

#[test]
fn degenerate_triangles() {
    // The fourth corner of a tetrahedron on the line of two others: one triangle is a needle, all are in one plane.
    let flat = tetrahedron([[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [1.0, 0.0, 0.0]]);
    let found = defects(&flat, plain());
    assert!(found.contains(&culprit(DegenerateTriangle, &[1])), "{found:?}");
    // Not exactly on the line: no needle.
    let mut thin = flat.clone();
    thin.vertices[3][1] = 5e-324;
    assert!(!defects(&thin, plain()).iter().any(|c| c.kind == DegenerateTriangle));
    // Points on a line whose rounded differences do not show it, and the other way round.
    let third = 1.0 / 3.0;
    let on = [[third; 3], [2.0 * third; 3], [4.0 * third; 3], [0.0, 1.0, 7.0]];
    assert!(defects(&tetrahedron(on), plain()).contains(&culprit(DegenerateTriangle, &[0])));
    // A repeated corner: its sides cancel, so nothing is open.
    let mut soup = cube(0.0, 1.0);
    soup.triangles.push([3, 3, 5]);
    assert_eq!(defects(&soup, plain()), [culprit(DegenerateTriangle, &[12])]);
    soup.triangles.push([4, 4, 4]);
    assert_eq!(defects(&soup, plain()).len(), 2);
}

#[test]
fn open_edge() {
    let mut soup = cube(0.0, 1.0);
    let gone = soup.triangles.remove(4);
    assert_eq!(gone, [0, 1, 5]);
    let expected = [[0, 1, 1], [0, 5, 4], [1, 5, 10]].map(|ids| culprit(OpenEdge, &ids));
    let error = build_soup(&soup, plain()).unwrap_err();
    assert_eq!(error.culprits, expected);
    let words =
        "the edge between vertices 0 and 1 is open: an odd number of triangles use it (triangle 1); and 2 more defects";
    assert_eq!(error.message, words);
    // Three triangles at an edge are odd as well.
    let mut fin = cube(0.0, 1.0);
    fin.vertices.push([5.0; 3]);
    fin.triangles.push([0, 1, 8]);
    let kinds: Vec<DefectKind> = defects(&fin, plain()).iter().map(|c| c.kind).collect();
    assert_eq!(kinds, [OpenEdge; 3]);
}

#[test]
fn inconsistent_orientation() {
    let mut soup = cube(0.0, 1.0);
    soup.triangles[4].swap(0, 1);
    let found = defects(&soup, plain());
    let expected = [[0, 1, 1], [0, 5, 4], [1, 5, 4]].map(|ids| culprit(InconsistentOrientation, &ids));
    assert_eq!(found, expected);
}

#[test]
fn duplicate_vertices() {
    // Two cubes that touch at a corner, each with its own.
    let soup = together(&[cube(0.0, 1.0), cube(1.0, 2.0)]);
    let error = build_soup(&soup, plain()).unwrap_err();
    assert_eq!(error.culprits, [culprit(DuplicateVertex, &[7, 8])]);
    let mesh = build_soup(&soup, merging()).unwrap();
    mesh.check().unwrap();
    assert_eq!(mesh.vertices.len(), 15);
    assert_eq!(mesh.vertex_source, (0..16).filter(|&v| v != 8).collect::<Vec<u32>>());
    assert_eq!((mesh.shells.len(), mesh.component_count), (2, 2));
    // A polygon soup: every triangle with its own corners.
    let whole = cube(0.0, 1.0);
    let split = Soup {
        vertices: whole.triangles.iter().flatten().map(|&i| whole.vertices[i as usize]).collect(),
        triangles: (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
    };
    let found = defects(&split, plain());
    assert_eq!(found.iter().filter(|c| c.kind == DuplicateVertex).count(), 28);
    assert_eq!(found.iter().filter(|c| c.kind == OpenEdge).count(), 36);
    let mesh = build_soup(&split, merging()).unwrap();
    assert_eq!((mesh.vertices.len(), mesh.edges.len()), (8, 18));
}

#[test]
fn zero_volume() {
    let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.25]];
    let sheet = Soup { vertices: points, triangles: vec![[0, 1, 2], [0, 2, 1]] };
    assert_eq!(defects(&sheet, plain()), [culprit(ZeroVolume, &[0])]);
    let found = defects(&together(&[cube(2.0, 3.0), sheet.clone()]), checking());
    assert_eq!(found, [culprit(ZeroVolume, &[12]), culprit(SelfIntersection, &[12, 13])]);
    // As thin as can be is not zero, in whatever direction.
    let mut thin = tetrahedron([[0.0; 3], [1e300, 0.0, 0.0], [0.0, 1e300, 0.0], [1e300, 1e300, 5e-324]]);
    assert!(build_soup(&thin, checking()).is_ok());
    thin.vertices[3][2] = -5e-324;
    assert_eq!(defects(&thin, checking()), [culprit(WrongNesting, &[0])]);
}

#[test]
fn several_defects_at_once() {
    let mut soup = together(&[cube(0.0, 1.0), cube(2.0, 3.0), cube(4.0, 5.0), flipped(cube(6.0, 7.0))]);
    soup.vertices.push(soup.vertices[0]);
    soup.triangles[0] = [32, soup.triangles[0][1], soup.triangles[0][2]];
    soup.vertices[9] = [f64::NAN, 2.0, 2.0];
    soup.triangles[25][2] = 1000;
    soup.triangles.push([30, 30, 31]);
    let points = [[9.0; 3], [10.0, 9.0, 9.0], [9.0, 10.0, 9.0]];
    soup.vertices.extend(points);
    soup.triangles.extend([[33, 34, 35], [33, 35, 34]]);
    let found = defects(&soup, plain());
    let mut sorted = found.clone();
    sorted.sort();
    assert_eq!(found, sorted);
    assert_eq!(found[0], culprit(NonFiniteCoordinate, &[9]));
    assert_eq!(found[1], culprit(IndexOutOfRange, &[25, 2, 1000]));
    assert_eq!(found[2], culprit(DegenerateTriangle, &[48]));
    let open: Vec<[i64; 2]> = found.iter().filter(|c| c.kind == OpenEdge).map(|c| [c.ids[0], c.ids[1]]).collect();
    // Vertex 32 stands for 0 in triangle 0 = (0, 2, 3): sides (0, 2) and (3, 0) lose a triangle, two new ones appear.
    assert_eq!(open, [[0, 2], [0, 3], [2, 32], [3, 32]]);
    assert!(found.contains(&culprit(DuplicateVertex, &[0, 32])));
    assert!(found.contains(&culprit(ZeroVolume, &[49])));
    assert_eq!(found.len(), 9);
}

#[test]
fn magnitudes_from_one_end_to_the_other() {
    for scale in [5e-324, 1e-310, 1e-200, 1e-100, 1.0, 1e100, 1e200, 2.5e307] {
        let nested = together(&[cube(-4.0 * scale, 4.0 * scale), flipped(cube(-scale, 2.0 * scale))]);
        let mesh = build_soup(&nested, checking()).unwrap_or_else(|e| panic!("{scale:e}: {e}"));
        mesh.check().unwrap();
        assert!(mesh.shells[0].outer && !mesh.shells[1].outer);
        assert_eq!(defects(&flipped(nested), checking()).len(), 1);
    }
    // At the very end: differences and products overflow, and sums of three terms may.
    let nested = together(&[cube(-f64::MAX, f64::MAX), flipped(cube(-1e-310, 1e308)), cube(0.0, 5e-324)]);
    let mesh = build_soup(&nested, checking()).unwrap();
    mesh.check().unwrap();
    assert_eq!(mesh.shells.iter().map(|s| s.outer).collect::<Vec<_>>(), [true, false, true]);
}

#[test]
fn edges_of_stars_and_repeated_corners() {
    // A vertex with many sides takes the other sort.
    for n in [3u32, 8, 30, 200] {
        let v = VertexId;
        let mut triangles: Vec<[VertexId; 3]> = Vec::new();
        for i in 0..n {
            triangles.push([v(0), v(2 + i), v(2 + (i * 7 + 1) % n)]);
            triangles.push([v(2 + i), v(1), v(2 + (i * 7 + 1) % n)]);
        }
        let table = edges::edge_table(n as usize + 2, &triangles);
        edges::check_edges(&triangles, &table.edges, &table.triangle_edges, &table.edge_uses).unwrap();
        let mut expected: Vec<[VertexId; 2]> = triangles
            .iter()
            .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]])
            .filter(|e| e[0] != e[1])
            .map(|e| [e[0].min(e[1]), e[0].max(e[1])])
            .collect();
        expected.sort();
        expected.dedup();
        assert_eq!(table.edges, expected);
    }
}
