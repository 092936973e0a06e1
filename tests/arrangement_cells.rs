//! Patches, cells, lines and winding numbers, on surfaces of unit cubes whose cells are found by looking at cubes, and on large nested and separate ones.

use lapidary::arrangement::cells::cells;
use lapidary::arrangement::patches::{patches, unbalanced_error};
use lapidary::arrangement::volumes::cell_volumes;
use lapidary::arrangement::winding::winding;
use lapidary::arrangement::{Arrangement, ArrangementOptions, Operand, Resolved, arrange};
use lapidary::base::{CellId, DefectKind, FaceId, Result, Run, Status};
use rug::Rational;
use std::collections::HashMap;
use std::time::Instant;

#[path = "common/mod.rs"]
mod common;
#[path = "common/grid_cubes.rs"]
mod grid_cubes;
use common::random::Random;
use grid_cubes::{GridCubes, Meshes, operands, resolved};

const UNIT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// Three times a rotation.
const TURNED: [[f64; 3]; 3] = [[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]];

/// The stages from a resolved surface on.
fn from_resolved(r: Resolved) -> Result<Arrangement> {
    let mut run = Run::quiet();
    let p = patches(&r, &mut run)?;
    if !p.unbalanced.is_empty() {
        return Err(unbalanced_error(&r, &[], &p.unbalanced));
    }
    p.check(&r).unwrap();
    let c = cells(&r, p, &mut run)?;
    c.check().unwrap();
    let w = winding(&c)?;
    w.check(&c).unwrap();
    Ok(Arrangement { resolved: r, cells: c, winding: w, stages: run.take_stages() })
}

fn dense(a: &Arrangement, c: usize) -> Vec<i32> {
    let mut row = vec![0; a.operand_count()];
    a.winding(CellId::of(c)).iter().for_each(|w| row[w.0.at()] = w.1);
    row
}

/// Cells are the regions of cubes, with their vectors and volumes.
fn assert_regions(a: &Arrangement, g: &GridCubes, map: [[f64; 3]; 3], what: &str) {
    let (region, vectors) = g.regions();
    assert_eq!(a.cell_count(), vectors.len(), "{what}");
    // The cube on each side of a face: a step along the normal from its centre, both in cube coordinates (times 3).
    let det = determinant(map);
    let back = inverse_times_determinant(map);
    let mut of_cell: HashMap<usize, usize> = HashMap::from([(0, 0)]);
    for f in 0..a.face_count() {
        let corners = a.resolved.faces[f].map(|v| {
            let x = a.coords(v);
            let p: [f64; 3] = std::array::from_fn(|i| (0..3).map(|k| back[i][k] * x[k]).sum::<f64>() / det);
            p.map(|c| c as i64)
        });
        let e: [i64; 3] = std::array::from_fn(|i| corners[1][i] - corners[0][i]);
        let d: [i64; 3] = std::array::from_fn(|i| corners[2][i] - corners[0][i]);
        let normal: [i64; 3] = std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            e[j] * d[k] - e[k] * d[j]
        });
        let low: [i64; 3] = std::array::from_fn(|i| corners.iter().map(|c| c[i]).min().unwrap());
        let side = |front: bool| {
            let mut cube = low;
            let axis = (0..3).find(|&i| normal[i] != 0).unwrap();
            if (normal[axis] > 0) != front {
                cube[axis] -= 1;
            }
            cube
        };
        let regions = [false, true].map(|front| region[&side(front)]);
        let cells = a.face_cells(FaceId::of(f));
        if g.vector(side(false)) == g.vector(side(true)) {
            assert!(cells[0].is_none() && cells[1].is_none(), "{what}: face {f} divides nothing");
            continue;
        }
        for (cell, region) in cells.into_iter().zip(regions) {
            assert!(cell.is_some(), "{what}: face {f} divides");
            assert_eq!(*of_cell.entry(cell.at()).or_insert(region), region, "{what}: cell {}", cell.0);
        }
    }
    assert_eq!(of_cell.len(), vectors.len(), "{what}");
    let volumes = cell_volumes(a);
    for (&cell, &region_of) in &of_cell {
        assert_eq!(dense(a, cell), vectors[region_of], "{what}: winding of cell {cell}");
        let cubes = if cell == 0 { 0 } else { region.values().filter(|&&r| r == region_of).count() };
        assert_eq!(volumes[cell], Rational::from(cubes) * det as i64, "{what}: volume of cell {cell}");
    }
}

fn determinant(m: [[f64; 3]; 3]) -> f64 {
    let minor = |i: usize, j: usize| m[1][i] * m[2][j] - m[1][j] * m[2][i];
    m[0][0] * minor(1, 2) + m[0][1] * minor(2, 0) + m[0][2] * minor(0, 1)
}

fn inverse_times_determinant(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let (a, b, c, d) = ((j + 1) % 3, (j + 2) % 3, (i + 1) % 3, (i + 2) % 3);
            m[a][c] * m[b][d] - m[a][d] * m[b][c]
        })
    })
}

#[test]
fn cubes_of_a_grid() {
    let mut random = Random(1);
    let started = Instant::now();
    let (mut cells, mut dead, mut negative) = (0, 0, 0);
    for round in 0..1500 {
        let n = 1 + random.below(4) as usize;
        let count = random.below(5) as usize;
        let fill = [10, 30, 50, 80, 100][random.below(5) as usize];
        let values: &[i32] = [&[1][..], &[1, -1], &[1, 2], &[-2, -1, 1, 2, 3]][random.below(4) as usize];
        let g = GridCubes::random(&mut random, n, count, fill, values);
        let map = if round % 3 == 0 { TURNED } else { UNIT };
        let meshes = g.meshes(map);
        let share = random.below(3);
        let r = resolved(&operands(&meshes), || share > 0 && random.below(share) == 0);
        let what = format!("round {round}");
        let a = from_resolved(r).unwrap();
        assert_regions(&a, &g, map, &what);
        cells += a.cell_count();
        dead += a.cells.patch.iter().filter(|p| p.is_none()).count();
        negative += (0..a.cell_count()).filter(|&c| dense(&a, c).iter().any(|&w| w < 0)).count();
    }
    assert!(cells > 5000 && dead > 5000 && negative > 500);
    println!(
        "{cells} cells, {negative} with negative numbers, {dead} faces that divide nothing; {:?}",
        started.elapsed()
    );
}

#[test]
fn cubes_of_a_grid_through_all_stages() {
    let mut random = Random(2);
    for round in 0..150 {
        let n = 1 + random.below(3) as usize;
        let g = GridCubes::random(&mut random, n, 1 + (round % 4), 50, &[-1, 1, 1, 2]);
        let map = if round % 2 == 0 { TURNED } else { UNIT };
        let meshes = g.meshes(map);
        let a = arrange(&operands(&meshes), &ArrangementOptions::default(), &mut Run::quiet()).unwrap();
        assert_regions(&a, &g, map, &format!("round {round}"));
    }
}

/// The boundary of a box, outward.
fn cuboid(lo: [f64; 3], hi: [f64; 3]) -> (Vec<[f64; 3]>, Vec<[i32; 3]>) {
    let s = common::cuboid(lo, hi);
    (s.vertices, s.triangles)
}

fn add(all: &mut (Vec<[f64; 3]>, Vec<[i32; 3]>), (vertices, triangles): (Vec<[f64; 3]>, Vec<[i32; 3]>)) {
    let first = all.0.len() as i32;
    all.0.extend(vertices);
    all.1.extend(triangles.iter().map(|t| t.map(|v| v + first)));
}

#[test]
fn shells_inside_one_another() {
    // Each winds once more around what is inside; every third one is turned inside out.
    let mut mesh = Default::default();
    let (mut numbers, mut w) = (vec![0], 0);
    for i in 0..100 {
        let x = 100.0 - i as f64;
        let (v, mut t) = cuboid([-x; 3], [x; 3]);
        if i % 3 == 2 {
            t.iter_mut().for_each(|t| t.swap(1, 2));
        }
        w += if i % 3 == 2 { -1 } else { 1 };
        numbers.push(w);
        add(&mut mesh, (v, t));
    }
    let meshes = vec![mesh];
    let a = from_resolved(resolved(&operands(&meshes), || false)).unwrap();
    assert_eq!(a.cell_count(), 101);
    // Cells are numbered by lowest half-face: from outside inward.
    let volumes = cell_volumes(&a);
    for c in 0..101 {
        assert_eq!(dense(&a, c), [numbers[c]]);
        let side = |c: usize| Rational::from(2 * (101 - c as i64));
        let cubed = |x: Rational| Rational::from(&x * &x) * x;
        let expected = match c {
            0 => Rational::new(),
            100 => Rational::from(8),
            _ => cubed(side(c)) - cubed(side(c + 1)),
        };
        assert_eq!(volumes[c], expected);
    }
}

#[test]
fn ten_thousand_components() {
    let mut random = Random(3);
    // Apart from one another, with other coordinates each; a third inside out, a third in the second operand; in rows along the axis of lines, and not.
    for side in [22usize, 10_000] {
        let mut meshes: Meshes = vec![Default::default(), Default::default()];
        let mut inside = Vec::new();
        for i in 0..10_000usize {
            let place = [i % side, i / side % 22, i / side / 22].map(|c| 4.0 * c as f64);
            let lo = place.map(|c| c + random.unit());
            let hi = lo.map(|c| c + 1.0 + random.unit());
            let (v, mut t) = cuboid(lo, hi);
            if i % 3 == 1 {
                t.iter_mut().for_each(|t| t.swap(1, 2));
            }
            add(&mut meshes[(i % 3 == 2) as usize], (v, t));
            inside.push([[1, 0], [-1, 0], [0, 1]][i % 3]);
        }
        let r = resolved(&operands(&meshes), || false);
        let started = Instant::now();
        let a = from_resolved(r).unwrap();
        println!("10 000 components in rows of {side}: {:?}", started.elapsed());
        assert_eq!(a.cell_count(), 10_001);
        for c in 1..a.cell_count() {
            let h = a.cells.lowest[c];
            let t = a.resolved.support[h.face().at()];
            let i = a.resolved.soup.source[t.at()] as usize / 12;
            let operand = a.resolved.soup.operand(t).at();
            // The first operand has two of three boxes.
            let i = if operand == 0 { i / 2 * 3 + i % 2 } else { i * 3 + 2 };
            assert_eq!(dense(&a, c), inside[i]);
            assert_eq!(a.face_cells(h.face()).iter().filter(|c| c.0 == 0).count(), 1);
        }
    }
}

#[test]
fn what_is_nested_in_what_is_nested() {
    // A box with boxes, each with boxes, in depth 4; all in one operand, and the innermost in another.
    let mut meshes: Meshes = vec![Default::default(), Default::default()];
    let mut expected = vec![0; 5];
    let mut stack = vec![([0.0; 3], 4096.0, 0)];
    while let Some((lo, size, depth)) = stack.pop() {
        add(&mut meshes[(depth == 4) as usize], cuboid(lo, lo.map(|c| c + size)));
        expected[depth] += 1;
        if depth < 4 {
            for k in 0..5 {
                let corner = std::array::from_fn(|i| {
                    lo[i] + size * (0.1 + 0.17 * ((k >> i & 1) as f64) + 0.35 * (k / 4) as f64)
                });
                stack.push((corner, size * 0.15, depth + 1));
            }
        }
    }
    let a = from_resolved(resolved(&operands(&meshes), || false)).unwrap();
    assert_eq!(a.cell_count(), 1 + expected.iter().sum::<usize>());
    let mut counts = vec![0; 5];
    for c in 1..a.cell_count() {
        match dense(&a, c)[..] {
            [4, 1] => counts[4] += 1,
            [depth, 0] if (1..=4).contains(&depth) => counts[depth as usize - 1] += 1,
            ref other => panic!("{other:?}"),
        }
    }
    assert_eq!(counts, expected);
}

#[test]
fn nothing_at_all() {
    let empty: Operand = Operand { vertices: &[], triangles: &[] };
    for all in [&[][..], &[empty], &[empty, empty]] {
        let a = arrange(all, &ArrangementOptions::default(), &mut Run::quiet()).unwrap();
        assert_eq!((a.cell_count(), a.patch_count(), a.face_count(), a.operand_count()), (1, 0, 0, all.len()));
        assert!(a.winding(CellId(0)).is_empty());
        assert_eq!(cell_volumes(&a), [Rational::new()]);
    }
    // An operand without triangles among others; a mesh and its reverse, of which nothing is left but its faces.
    let (v, t) = cuboid([0.0; 3], [1.0; 3]);
    let back: Vec<[i32; 3]> = t.iter().map(|t| [t[0], t[2], t[1]]).collect();
    let both: Vec<[i32; 3]> = t.iter().chain(&back).copied().collect();
    let a = arrange(
        &[empty, Operand { vertices: &v, triangles: &t }, empty, Operand { vertices: &v, triangles: &both }],
        &ArrangementOptions::default(),
        &mut Run::quiet(),
    )
    .unwrap();
    assert_eq!((a.cell_count(), a.patch_count(), a.face_count()), (2, 1, 12));
    assert_eq!(dense(&a, 1), [0, 1, 0, 0]);
    let a = arrange(&[Operand { vertices: &v, triangles: &both }], &ArrangementOptions::default(), &mut Run::quiet());
    let a = a.unwrap();
    assert_eq!((a.cell_count(), a.patch_count(), a.face_count()), (1, 0, 12));
    assert_eq!(a.resolved.births.items.len(), 24);
}

#[test]
fn open_meshes_are_named() {
    let (v, t) = cuboid([0.0; 3], [1.0; 3]);
    let whole = Operand { vertices: &v, triangles: &t };
    let far: Vec<[f64; 3]> = v.iter().map(|x| [x[0] + 5.0, x[1], x[2]]).collect();
    for gone in 0..12 {
        let open: Vec<[i32; 3]> = t.iter().enumerate().filter(|(i, _)| *i != gone).map(|(_, t)| *t).collect();
        for vertices in [&v, &far] {
            let list = [whole, whole, Operand { vertices, triangles: &open }];
            let e = arrange(&list, &ArrangementOptions::default(), &mut Run::quiet()).unwrap_err();
            assert_eq!(e.status, Status::BadMesh);
            assert!(e.message.starts_with("operand 2, triangle "), "{}", e.message);
            assert!(e.message.contains("do not balance at the edge from vertex "), "{}", e.message);
            let mut edges: Vec<[i64; 2]> = (0..3).map(|i| [t[gone][i], t[gone][(i + 1) % 3]].map(i64::from)).collect();
            edges.iter_mut().for_each(|e| e.sort());
            edges.sort();
            let mut found: Vec<[i64; 2]> = Vec::new();
            for c in &e.culprits {
                assert_eq!((c.kind, c.ids[0]), (DefectKind::UnbalancedEdge, 2));
                found.push([c.ids[1].min(c.ids[2]), c.ids[1].max(c.ids[2])]);
            }
            found.sort();
            assert_eq!(found, edges);
        }
        // Turned, not gone: the same edges do not balance.
        let mut turned = t.clone();
        turned[gone].swap(0, 1);
        let list = [Operand { vertices: &v, triangles: &turned }];
        let e = arrange(&list, &ArrangementOptions::default(), &mut Run::quiet()).unwrap_err();
        assert_eq!((e.status, e.culprits.len()), (Status::BadMesh, 3));
    }
    // Two operands do not close one another.
    let (some, rest) = t.split_at(5);
    let list = [Operand { vertices: &v, triangles: some }, Operand { vertices: &v, triangles: rest }];
    let e = arrange(&list, &ArrangementOptions::default(), &mut Run::quiet()).unwrap_err();
    assert!(e.culprits.iter().any(|c| c.ids[0] == 0) && e.culprits.iter().any(|c| c.ids[0] == 1));
}

#[test]
fn edges_in_pieces_balance() {
    // One side of a box has an edge in two pieces, the other has it whole; a third vertex of one triangle is in the middle of another's edge.
    let v = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
        [0.0, 0.0, 2.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.5, 0.5, 0.0],
    ];
    let t = [[0, 2, 4], [4, 2, 5], [4, 5, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let a =
        arrange(&[Operand { vertices: &v, triangles: &t }], &ArrangementOptions::default(), &mut Run::quiet()).unwrap();
    assert_eq!(a.cell_count(), 2);
    assert_eq!(cell_volumes(&a)[1], Rational::from((4, 3)));
    // One piece missing: an error that names an edge with an end that is no vertex of a triangle there, but of the operand.
    let e = arrange(&[Operand { vertices: &v, triangles: &t[1..] }], &ArrangementOptions::default(), &mut Run::quiet());
    let e = e.unwrap_err();
    assert_eq!(e.status, Status::BadMesh);
    assert!(e.culprits.iter().any(|c| c.ids == [0, 0, 4]), "{:?}", e.culprits);
}

#[test]
fn threads_do_not_matter() {
    let mut random = Random(4);
    let g = GridCubes::random(&mut random, 12, 3, 40, &[1, -1, 2]);
    let meshes = g.meshes(TURNED);
    let made = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut random = Random(5);
            from_resolved(resolved(&operands(&meshes), || random.below(2) == 0)).unwrap()
        })
    };
    let one = made(1);
    assert_regions(&one, &g, TURNED, "12 cubes a side");
    for threads in [2, 5] {
        let other = made(threads);
        assert_eq!(one.cells.of, other.cells.of);
        assert_eq!(one.cells.patch, other.cells.patch);
        assert_eq!(one.winding.rows, other.winding.rows);
        assert_eq!(one.cells.multiplicity, other.cells.multiplicity);
        assert_eq!(one.cells.lowest, other.cells.lowest);
    }
}
