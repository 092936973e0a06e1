//! Soups of triangles with small whole coordinates, closed by construction and degenerate throughout, through the C functions of arrangements: what
//! comes back is in range and adds up, exactly. Broken ones are refused with a status as documented. `LAPIDARY_FUZZ=n` runs n rounds,
//! `LAPIDARY_FUZZ_SEED=n` on other soups.

#[path = "common/random.rs"]
mod random;

use lapidary::capi::{
    arrangement::*, arrangement_extract::*, arrangement_views::*, complex::*, context::*, derived::*, keys::*, mesh::*,
    status::*, surface::*, surface_certify::*,
};
use random::Random;
use rug::Rational;
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};

fn rounds(default: usize) -> usize {
    std::env::var("LAPIDARY_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

#[derive(Clone, Default)]
struct Mesh {
    xyz: Vec<[f64; 3]>,
    triangles: Vec<[i32; 3]>,
}

/// Boundaries of tetrahedra between random points, in any orientation, flat ones included: a closed surface, whatever they are. Sometimes all
/// on one plane, sometimes twice, sometimes with a midpoint on an edge that only one side knows of. Turned, so that planes are nearly the same that were the
/// same, there is no such edge.
fn soup(r: &mut Random, turned: bool) -> Mesh {
    let mut m = Mesh::default();
    let range = [1, 1, 2, 3, 6][r.below(5) as usize];
    let flat = r.below(12) == 0;
    let points = 4 + r.below(8);
    for _ in 0..points {
        let mut p: [f64; 3] = std::array::from_fn(|_| r.within(range));
        if flat {
            p[2] = p[0] - p[1];
        }
        if turned {
            let rows = [[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]];
            p = rows.map(|row: [f64; 3]| (0..3).map(|k| row[k] * p[k]).sum::<f64>() / 3.0);
        }
        m.xyz.push(p);
    }
    for _ in 0..1 + r.below(4) {
        let [a, b, c, d]: [i32; 4] = std::array::from_fn(|_| r.below(points) as i32);
        let mut boundary = [[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
        if r.below(2) == 0 {
            boundary.iter_mut().for_each(|t| t.swap(1, 2));
        }
        for _ in 0..1 + (r.below(6) == 0) as usize {
            m.triangles.extend(boundary);
        }
        if r.below(4) == 0 && !turned {
            // One triangle is halved, its neighbour is not.
            let t = m.triangles.pop().unwrap();
            let [p, q] = [m.xyz[t[0] as usize], m.xyz[t[1] as usize]];
            let middle = m.xyz.len() as i32;
            m.xyz.push(std::array::from_fn(|k| (p[k] + q[k]) / 2.0));
            m.triangles.extend([[t[0], middle, t[2]], [middle, t[1], t[2]]]);
        }
    }
    m
}

fn operands(meshes: &[Mesh]) -> Vec<lap_operand> {
    let one = |m: &Mesh| lap_operand {
        n_vertices: m.xyz.len() as i64,
        xyz: m.xyz.as_ptr().cast(),
        n_triangles: m.triangles.len() as i64,
        indices: m.triangles.as_ptr().cast(),
    };
    meshes.iter().map(one).collect()
}

unsafe fn text(at: *const std::ffi::c_char) -> String {
    unsafe { CStr::from_ptr(at) }.to_str().unwrap().to_string()
}

/// A view, copied and looked through: all of `count` numbers are from `low` up to `high`.
unsafe fn view(at: *const i32, count: usize, low: i64, high: i64) -> Vec<i32> {
    let all = if count == 0 { Vec::new() } else { unsafe { std::slice::from_raw_parts(at, count) }.to_vec() };
    let out = all.iter().position(|&x| !(low..high).contains(&i64::from(x)));
    assert_eq!(out, None, "{:?} is not in {low}..{high}", out.map(|i| all[i]));
    all
}

unsafe fn offsets(at: *const i32, rows: usize) -> Vec<i32> {
    let all = unsafe { view(at, rows + 1, 0, i32::MAX.into()) };
    assert!(all[0] == 0 && all.is_sorted());
    all
}

struct Made<'a> {
    context: *mut lap_context,
    arrangement: *const lap_arrangement,
    meshes: &'a [Mesh],
    vertices: usize,
    faces: usize,
    cells: usize,
}

impl Made<'_> {
    unsafe fn exact(&self, v: i32) -> [Rational; 3] {
        let mut at = [null(); 3];
        let [x, y, z] = &mut at;
        unsafe {
            let status = lap_arrangement_vertex_exact(self.context, self.arrangement, v, x, y, z);
            assert_eq!(status, LAP_OK);
            at.map(|s| text(s).parse().unwrap())
        }
    }

    /// Every array is in range and says what the others say. Returns how many vertices were constructed.
    unsafe fn arrays(&self) -> usize {
        let (a, n) = (self.arrangement, self.meshes.len() as i64);
        let total: i64 = self.meshes.iter().map(|m| m.triangles.len() as i64).sum();
        let (mut count, mut xyz, mut p, mut q, mut s, mut t, mut u) =
            (0, null(), null(), null(), null(), null(), null());
        let (mut bytes, mut patches) = (null(), 0);
        unsafe {
            lap_arrangement_counts(a, null_mut(), null_mut(), &mut patches, null_mut(), null_mut(), null_mut());
            assert_eq!(lap_arrangement_vertices(a, &mut count, &mut xyz), LAP_OK);
            assert_eq!(count as usize, self.vertices);
            for v in 0..self.vertices {
                let exact = self.exact(v as i32);
                for (k, x) in exact.iter().enumerate() {
                    let got = *xyz.add(3 * v + k);
                    let off = |x: f64| (Rational::from_f64(x).unwrap() - &exact[k]).abs();
                    assert!(off(got) <= off(got.next_up()) && off(got) <= off(got.next_down()), "{got} for {x}");
                }
            }
            assert_eq!(lap_arrangement_vertex_origins(a, &mut count, &mut p, &mut q), LAP_OK);
            let kinds = view(p, self.vertices, LAP_VERTEX_MESH.into(), LAP_VERTEX_TRIANGLES as i64 + 1);
            let ids = view(q, 3 * self.vertices, -1, 1 << 20);
            let given: Vec<[f64; 3]> = self.meshes.iter().flat_map(|m| m.xyz.iter().copied()).collect();
            for (v, kind) in kinds.iter().enumerate() {
                if *kind == LAP_VERTEX_MESH {
                    let x: [f64; 3] = std::array::from_fn(|k| *xyz.add(3 * v + k));
                    assert_eq!(given[ids[3 * v] as usize], x);
                } else {
                    assert!(
                        *kind == LAP_VERTEX_TRIANGLES && ids[3 * v..3 * v + 3].iter().all(|&t| i64::from(t) < total)
                    );
                }
            }
            assert_eq!(lap_arrangement_faces(a, &mut count, &mut p, &mut q, &mut s), LAP_OK);
            assert_eq!(count as usize, self.faces);
            view(p, 3 * self.faces, 0, self.vertices as i64);
            let of_patch = view(q, self.faces, -1, patches);
            let sides = view(s, 2 * self.faces, -1, self.cells as i64);
            let (mut o, mut w) = (null(), null());
            assert_eq!(lap_arrangement_face_births(a, &mut count, &mut o, &mut p, &mut q, &mut bytes), LAP_OK);
            let births = offsets(o, self.faces);
            let all = births[self.faces] as usize;
            let (birth_operand, birth_triangle) = (view(p, all, 0, n), view(q, all, 0, 1 << 20));
            let reversed: Vec<u8> = (0..all).map(|i| *bytes.add(i)).collect();
            assert!(reversed.iter().all(|&b| b <= 1));
            for i in 0..all {
                assert!((birth_triangle[i] as usize) < self.meshes[birth_operand[i] as usize].triangles.len());
            }
            assert_eq!(lap_arrangement_cells(a, &mut count, &mut o, &mut t, &mut w), LAP_OK);
            assert_eq!(count as usize, self.cells);
            let rows = offsets(o, self.cells);
            let windings = view(w, rows[self.cells] as usize, i32::MIN.into(), i32::MAX.into());
            let operands = view(t, windings.len(), 0, n);
            let row = |c: i32| -> BTreeMap<i32, i32> {
                let range = rows[c as usize] as usize..rows[c as usize + 1] as usize;
                range.map(|i| (operands[i], windings[i])).collect()
            };
            assert!(row(0).is_empty() && !windings.contains(&0));
            assert_eq!(lap_arrangement_patches(a, &mut count, &mut p, &mut q, &mut s, &mut t, &mut u), LAP_OK);
            assert_eq!(count, patches);
            let lowest = view(p, patches as usize, 0, self.faces as i64);
            view(q, 2 * patches as usize, 0, self.cells as i64);
            let of_patches = offsets(s, patches as usize);
            view(t, of_patches[patches as usize] as usize, 0, n);
            assert!(lowest.iter().enumerate().all(|(p, &f)| of_patch[f as usize] == p as i32));
            // Across a face every winding number falls by what its births say.
            for f in 0..self.faces {
                let mut net = BTreeMap::new();
                for i in births[f] as usize..births[f + 1] as usize {
                    *net.entry(birth_operand[i]).or_insert(0) += if reversed[i] == 0 { 1 } else { -1 };
                }
                net.retain(|_, m| *m != 0);
                let cells = [sides[2 * f], sides[2 * f + 1]];
                assert_eq!(net.is_empty(), of_patch[f] == -1);
                if net.is_empty() {
                    assert_eq!(cells, [-1, -1]);
                    continue;
                }
                let (mut behind, front) = (row(cells[0]), row(cells[1]));
                for (operand, m) in net.iter().map(|(o, m)| (*o, -m)).chain(front.into_iter().map(|(o, w)| (o, -w))) {
                    *behind.entry(operand).or_insert(0) += m;
                }
                assert!(cells[0] != cells[1] && behind.values().all(|w| *w == 0), "face {f}: {behind:?}");
            }
            kinds.iter().filter(|k| **k == LAP_VERTEX_TRIANGLES).count()
        }
    }

    /// The exact volume of a surface, which is balanced, in range, and made of what it says. The volume is also that of its triangles.
    unsafe fn volume(&self, surface: *mut lap_surface, deep: bool) -> Rational {
        let (mut n, mut count, mut sources, mut v, mut o, mut t) = (0, 0, null(), null(), null(), null());
        let (mut xyz, mut flipped, mut births, mut against) = (null(), null(), null(), null());
        unsafe {
            assert_eq!(lap_surface_vertices(surface, &mut n, &mut xyz, &mut sources), LAP_OK);
            let sources = view(sources, n as usize, 0, self.vertices as i64);
            assert!(sources.is_sorted_by(|a, b| a < b));
            assert_eq!(lap_surface_triangles(surface, &mut count, &mut v, &mut o, &mut t, &mut flipped), LAP_OK);
            let corners = view(v, 3 * count as usize, 0, n);
            let operands = view(o, count as usize, 0, self.meshes.len() as i64);
            let triangles = view(t, count as usize, 0, 1 << 20);
            let status = lap_surface_polygons(surface, &mut count, null_mut(), null_mut(), &mut births, &mut against);
            assert_eq!(status, LAP_OK);
            assert!(view(births, count as usize, 0, self.faces as i64).is_sorted_by(|a, b| a < b));
            let mut edges = BTreeMap::new();
            for c in corners.chunks_exact(3) {
                for i in 0..3 {
                    let (from, to) = (c[i], c[(i + 1) % 3]);
                    *edges.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { -1 };
                }
            }
            assert!(edges.values().all(|net| *net == 0), "not closed");
            let mut at = null();
            assert_eq!(lap_surface_volume_exact(self.context, surface, &mut at), LAP_OK);
            let volume: Rational = text(at).parse().unwrap();
            let mut rounded = f64::NAN;
            assert_eq!(lap_surface_volume(surface, &mut rounded), LAP_OK);
            assert!((rounded - volume.to_f64()).abs() <= f64::EPSILON * rounded);
            if deep {
                let points: Vec<[Rational; 3]> = sources.iter().map(|&v| self.exact(v)).collect();
                let mut six = Rational::new();
                for (i, c) in corners.chunks_exact(3).enumerate() {
                    let [p, q, r] = [0, 1, 2].map(|k| &points[c[k] as usize]);
                    six += determinant(p, q, r);
                    // In the plane of the triangle that it is a part of, and turned as it says.
                    let mesh = &self.meshes[operands[i] as usize];
                    let of = mesh.triangles[triangles[i] as usize]
                        .map(|v| mesh.xyz[v as usize].map(|x| Rational::from_f64(x).unwrap()));
                    let [normal, part] = [normal(&of[0], &of[1], &of[2]), normal(p, q, r)];
                    let along = dot(&normal, &part);
                    let lengths = dot(&normal, &normal) * dot(&part, &part);
                    assert_eq!(Rational::from(&along * &along), lengths, "not parallel");
                    assert_eq!(along < 0, *flipped.add(i) == 1);
                    let off: [Rational; 3] = std::array::from_fn(|k| Rational::from(&p[k] - &of[0][k]));
                    assert_eq!(dot(&normal, &off), 0, "not in its plane");
                }
                assert_eq!(six / 6, volume);
            }
            assert_eq!(lap_surface_free(surface), LAP_OK);
            volume
        }
    }

    /// On doubles: what the report says is what an independent check finds, and certified is solid, the same again, and near.
    unsafe fn certified(&self, operation: i32, options: *const lap_surface_certify_options) -> bool {
        let (mut surface, mut certified) = (null_mut(), null_mut());
        unsafe {
            assert_eq!(lap_arrangement_extract(self.context, self.arrangement, operation, 2, &mut surface), LAP_OK);
            assert_eq!(lap_surface_certify(self.context, surface, options, &mut certified), LAP_OK);
            assert_eq!(lap_surface_free(surface), LAP_OK);
            let mut r: lap_surface_certify_report = std::mem::zeroed();
            let size = size_of::<lap_surface_certify_report>() as i32;
            assert_eq!(lap_surface_certified_report(certified, &mut r, size), LAP_OK);
            let (mut n, mut count, mut open) = (0, 0, 0);
            let (mut xyz, mut s, mut v, mut o, mut t, mut births, mut pairs) =
                (null(), null(), null(), null(), null(), null(), null());
            assert_eq!(lap_surface_vertices(certified, &mut n, &mut xyz, &mut s), LAP_OK);
            let sources = view(s, n as usize, -1, self.vertices as i64);
            assert_eq!(lap_surface_triangles(certified, &mut count, &mut v, &mut o, &mut t, null_mut()), LAP_OK);
            view(v, 3 * count as usize, 0, n);
            view(t, count as usize, 0, 1 << 20);
            view(o, count as usize, 0, self.meshes.len() as i64);
            let status = lap_surface_polygons(certified, &mut count, null_mut(), null_mut(), &mut births, null_mut());
            assert_eq!(status, LAP_OK);
            view(births, count as usize, 0, self.faces as i64);
            assert_eq!(lap_surface_certified_open(certified, &mut open, &mut pairs), LAP_OK);
            view(pairs, 2 * open as usize, 0, count);
            assert!(r.triangles_after == count && r.open_pairs == open && (r.certified == 0 || open == 0));
            assert_eq!(sources.iter().filter(|s| **s < 0).count() as i64, r.moved_vertices);
            if r.certified == 1 && count > 0 {
                let status = lap_mesh_validate(self.context, n, xyz, count, v, null(), null_mut());
                assert_eq!(status, LAP_OK);
                let one = [lap_operand { n_vertices: n, xyz, n_triangles: count, indices: v }];
                let (mut again, mut met) = (null_mut(), -1);
                assert_eq!(lap_arrangement_new(self.context, 1, one.as_ptr(), null(), &mut again), LAP_OK);
                let out = null_mut();
                lap_arrangement_counts(again, null_mut(), null_mut(), null_mut(), out, &mut met, null_mut());
                assert_eq!(met, 0);
                assert_eq!(lap_arrangement_free(again), LAP_OK);
            }
            assert_eq!(lap_surface_free(certified), LAP_OK);
            r.certified == 1
        }
    }

    unsafe fn operation(&self, operation: i32, deep: bool) -> Rational {
        let mut surface = null_mut();
        unsafe {
            assert_eq!(lap_arrangement_extract(self.context, self.arrangement, operation, 2, &mut surface), LAP_OK);
            self.volume(surface, deep)
        }
    }

    unsafe fn expression(&self, expression: &CStr) -> Rational {
        let mut surface = null_mut();
        unsafe {
            let text = expression.as_ptr();
            let status = lap_arrangement_extract_expression(self.context, self.arrangement, text, &mut surface);
            assert_eq!(status, LAP_OK);
            self.volume(surface, false)
        }
    }
}

fn normal(p: &[Rational; 3], q: &[Rational; 3], r: &[Rational; 3]) -> [Rational; 3] {
    let side = |to: &[Rational; 3], k: usize| Rational::from(&to[k] - &p[k]);
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        side(q, j) * side(r, k) - side(q, k) * side(r, j)
    })
}

fn dot(a: &[Rational; 3], b: &[Rational; 3]) -> Rational {
    (0..3).map(|k| Rational::from(&a[k] * &b[k])).sum()
}

fn determinant(p: &[Rational; 3], q: &[Rational; 3], r: &[Rational; 3]) -> Rational {
    let cross: [Rational; 3] = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        Rational::from(&q[j] * &r[k]) - Rational::from(&q[k] * &r[j])
    });
    dot(p, &cross)
}

#[test]
fn soups_of_small_whole_numbers_add_up() {
    let seed: u64 = std::env::var("LAPIDARY_FUZZ_SEED").ok().and_then(|n| n.parse().ok()).unwrap_or(0);
    let mut r = Random(0x626f_6f6c_6561_6e73 ^ seed << 20);
    let (mut made, mut bad, mut constructed, mut doubled, mut uncertified) = (0, 0, 0, 0, 0);
    let check_only = lap_surface_certify_options {
        struct_size: size_of::<lap_surface_certify_options>() as i32,
        check_only: 1,
        max_rounds: 0,
    };
    unsafe {
        let mut context = null_mut();
        assert_eq!(lap_context_new(&mut context), LAP_OK);
        for round in 0..rounds(400) {
            // A failure names its round; this is for those that end the process.
            if std::env::var_os("LAPIDARY_FUZZ_TRACE").is_some() {
                eprintln!("round {round}");
            }
            let turned = r.below(4) == 0;
            let mut meshes: Vec<Mesh> = (0..1 + r.below(4)).map(|_| soup(&mut r, turned)).collect();
            if r.below(5) == 0 {
                let copy = meshes[0].clone();
                meshes.push(copy);
            }
            let broken = r.below(8) == 0;
            if broken {
                let m = r.below(meshes.len() as u64) as usize;
                let m = &mut meshes[m];
                match r.below(4) {
                    0 => drop(m.triangles.pop()),
                    1 => m.triangles[0].swap(0, 1),
                    2 => m.triangles[0][1] = [-1, m.xyz.len() as i32, i32::MAX, i32::MIN][r.below(4) as usize],
                    _ => m.xyz[0][1] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][r.below(3) as usize],
                }
            }
            let given = operands(&meshes);
            let mut arrangement = null_mut();
            let n = given.len() as i64;
            let status = lap_arrangement_new(context, n, given.as_ptr(), null(), &mut arrangement);
            assert_eq!(status == LAP_OK, !arrangement.is_null(), "round {round}");
            if status != LAP_OK {
                let (mut message, mut defects) = (null(), 0);
                lap_context_last_error(context, null_mut(), &mut message);
                lap_context_last_defects(context, &mut defects, null_mut(), null_mut());
                let message = text(message);
                assert!(broken && status == LAP_ERR_BAD_MESH, "round {round}: {status}: {message}");
                assert!(message.contains("operand") && defects > 0, "round {round}: {message}");
                bad += 1;
                continue;
            }
            made += 1;
            let (mut v, mut f, mut c) = (0, 0, 0);
            lap_arrangement_counts(arrangement, &mut v, &mut f, null_mut(), &mut c, null_mut(), null_mut());
            let a = Made {
                context,
                arrangement,
                meshes: &meshes,
                vertices: v as usize,
                faces: f as usize,
                cells: c as usize,
            };
            constructed += (a.arrays() > 0) as i32;
            // Cells are solid, each of them, and their volumes those of the booleans.
            let (mut volumes, mut text_at, mut o, mut w) = (null(), null(), null(), null());
            lap_arrangement_cells(arrangement, &mut c, &mut o, null_mut(), &mut w);
            let rows = offsets(o, a.cells);
            let mut weighted = Rational::new();
            for cell in 0..a.cells {
                assert_eq!(lap_arrangement_cell_volume_exact(context, arrangement, cell as i32, &mut text_at), LAP_OK);
                let volume: Rational = text(text_at).parse().unwrap();
                assert!((cell == 0) == (volume == 0) && volume >= 0, "round {round}: cell {cell}: {volume}");
                let mut surface = null_mut();
                let mut table = vec![0u8; a.cells];
                table[cell] = 1;
                let status = lap_arrangement_extract_table(context, arrangement, c, table.as_ptr(), &mut surface);
                assert_eq!(status, if cell == 0 { LAP_ERR_BAD_ARGUMENT } else { LAP_OK }, "round {round}");
                if cell > 0 {
                    assert_eq!(a.volume(surface, false), volume, "round {round}: cell {cell}");
                }
                let sum: i32 = (rows[cell]..rows[cell + 1]).map(|i| *w.add(i as usize)).sum();
                weighted += volume * sum;
                doubled += (rows[cell]..rows[cell + 1]).any(|i| (*w.add(i as usize)).abs() > 1) as i32;
            }
            assert_eq!(lap_arrangement_cell_volumes(arrangement, &mut c, &mut volumes), LAP_OK);
            // Winding numbers times volumes: what the triangles that were given say.
            let mut six = Rational::new();
            for m in &meshes {
                for t in &m.triangles {
                    let [p, q, r] = t.map(|v| m.xyz[v as usize].map(|x| Rational::from_f64(x).unwrap()));
                    six += determinant(&p, &q, &r);
                }
            }
            assert_eq!(weighted, six / 6, "round {round}");
            let union = a.operation(LAP_EXTRACT_UNION, true);
            if meshes.len() >= 2 {
                let [both, first, second] = [c"0 & 1", c"0", c"1"].map(|e| a.expression(e));
                assert_eq!(a.expression(c"0 | 1") + &both, Rational::from(&first + &second), "round {round}");
                assert_eq!(a.expression(c"0 - 1"), Rational::from(&first - &both), "round {round}");
                let one = a.expression(c"0 ^ 1");
                assert_eq!(one, first + second - Rational::from(&both * 2), "round {round}");
            }
            // At least one, or an odd number, or at least two: inclusion and exclusion for two; else bounds.
            let [some, odd, twice, all] =
                [LAP_EXTRACT_RESOLVE, LAP_EXTRACT_SYMMETRIC_DIFFERENCE, LAP_EXTRACT_AT_LEAST, LAP_EXTRACT_INTERSECTION]
                    .map(|operation| a.operation(operation, round % 4 == 0));
            assert!(some >= 0 && odd <= union && all <= union && twice <= union, "round {round}");
            match meshes.len() {
                1 => assert!(odd == union && all == union && twice == 0 && some == union, "round {round}"),
                2 => assert!(twice == all && odd == union - all, "round {round}"),
                _ => {}
            }
            for operation in LAP_EXTRACT_UNION..=LAP_EXTRACT_RESOLVE {
                assert!(a.certified(operation, null()), "round {round}: operation {operation}");
                uncertified += !a.certified(operation, &check_only) as i32;
            }
            assert_eq!(lap_arrangement_free(arrangement), LAP_OK);
        }
        assert_eq!(lap_context_free(context), LAP_OK);
    }
    println!(
        "{made} arrangements, {constructed} with points where triangles meet, {doubled} cells wound around twice; {bad} refused; {uncertified} surfaces that rounding broke"
    );
    assert!(made > 5 * bad && bad > 0 && 2 * constructed > made && doubled > 0 && uncertified > 0);
}

#[test]
fn soups_and_half_spaces_add_up() {
    let mut r = Random(0x706c_616e_6573);
    let (mut made, mut refused, mut cells_on_planes) = (0, 0, 0);
    unsafe {
        let mut context = null_mut();
        assert_eq!(lap_context_new(&mut context), LAP_OK);
        for round in 0..rounds(200) {
            if std::env::var_os("LAPIDARY_FUZZ_TRACE").is_some() {
                eprintln!("half-spaces, round {round}");
            }
            let meshes: Vec<Mesh> = (0..r.below(3)).map(|_| soup(&mut r, false)).collect();
            let given = operands(&meshes);
            let scale = [1.0, 3.0, 0.1, 1e150, 1e-200][r.below(5) as usize];
            let mut planes: Vec<[f64; 4]> = (0..1 + r.below(5))
                .map(|_| {
                    let n: [f64; 3] = std::array::from_fn(|_| r.within(2));
                    [n[0], n[1], n[2], r.within(6) / 2.0].map(|x| scale * x)
                })
                .collect();
            if r.below(3) == 0 {
                // The same or the opposite one.
                let sign = r.within(1);
                planes.push(planes[0].map(|x| x * sign));
            }
            let bad = planes.iter().any(|p| p[..3] == [0.0; 3]);
            let low: [f64; 3] = std::array::from_fn(|_| r.within(4) / 2.0);
            let bounds = [low, low.map(|x| x + r.below(5) as f64)];
            let flat = (0..3).any(|i| bounds[0][i] == bounds[1][i]);
            let own = r.below(2) == 0;
            let has_vertices = meshes.iter().any(|m| !m.xyz.is_empty());
            let mut arrangement = null_mut();
            let status = lap_arrangement_new_half_spaces(
                context,
                given.len() as i64,
                given.as_ptr(),
                planes.len() as i64,
                planes.as_ptr().cast(),
                if own { bounds.as_ptr().cast() } else { null() },
                null(),
                &mut arrangement,
            );
            assert_eq!(status == LAP_OK, !arrangement.is_null(), "round {round}");
            let expected = match (bad, if own { flat } else { !has_vertices }) {
                (true, _) => LAP_ERR_BAD_PLANE,
                (_, true) => LAP_ERR_BAD_ARGUMENT,
                _ => LAP_OK,
            };
            assert_eq!(status, expected, "round {round}");
            if status != LAP_OK {
                refused += 1;
                continue;
            }
            made += 1;
            let (mut complex, mut again) = (null(), null());
            assert_eq!(lap_arrangement_complex(context, arrangement, &mut complex), LAP_OK, "round {round}");
            assert_eq!(lap_complex_check(context, complex), LAP_OK, "round {round}");
            let (mut count, mut cells, mut kinds) = (0, 0, null());
            lap_arrangement_counts(arrangement, null_mut(), null_mut(), null_mut(), &mut cells, null_mut(), null_mut());
            lap_complex_face_supports(complex, &mut count, &mut kinds, null_mut(), null_mut(), null_mut());
            cells_on_planes += (0..count as usize).filter(|&i| *kinds.add(i) == LAP_SUPPORT_PLANE).count();
            // The cells' volumes are the same from the complex, and winding numbers times volumes those of the meshes.
            let (mut rows, mut of, mut w, mut at) = (null(), null(), null(), null());
            lap_arrangement_cells(arrangement, &mut count, &mut rows, &mut of, &mut w);
            let rows = offsets(rows, cells as usize);
            let mut weighted = Rational::new();
            for cell in 1..cells as i32 {
                assert_eq!(lap_arrangement_cell_volume_exact(context, arrangement, cell, &mut at), LAP_OK);
                let volume: Rational = text(at).parse().unwrap();
                assert_eq!(lap_complex_cell_volume_exact(context, complex, cell - 1, &mut at), LAP_OK);
                assert!(volume > 0 && text(at).parse::<Rational>().unwrap() == volume, "round {round}: cell {cell}");
                for i in rows[cell as usize] as usize..rows[cell as usize + 1] as usize {
                    if (*of.add(i) as usize) < meshes.len() {
                        weighted += Rational::from(&volume * *w.add(i));
                    } else {
                        assert_eq!(*w.add(i), 1, "round {round}: a half-space in cell {cell}");
                    }
                }
            }
            let mut six = Rational::new();
            for t in meshes.iter().flat_map(|m| m.triangles.iter().map(move |t| t.map(|v| m.xyz[v as usize]))) {
                let [p, q, s] = t.map(|x| x.map(|x| Rational::from_f64(x).unwrap()));
                six += determinant(&p, &q, &s);
            }
            assert_eq!(weighted, six / 6, "round {round}");
            // A half-space and what is not in it.
            let first = CString::new(format!("{}", meshes.len())).unwrap();
            let mut surface = null_mut();
            let status = lap_arrangement_extract_expression(context, arrangement, first.as_ptr(), &mut surface);
            assert_eq!(status, LAP_OK, "round {round}");
            assert_eq!(lap_surface_complex(context, surface, &mut again), LAP_OK, "round {round}");
            assert_eq!(lap_complex_check(context, again), LAP_OK, "round {round}");
            for c in [complex, again] {
                let mut keys = null();
                assert_eq!(lap_complex_face_keys(c, &mut count, &mut keys), LAP_OK, "round {round}: keys");
                let all: BTreeSet<[i64; 2]> =
                    (0..count as usize).map(|f| [*keys.add(2 * f), *keys.add(2 * f + 1)]).collect();
                assert!(
                    all.len() == count as usize && all.iter().all(|k| k[0] >= 0),
                    "round {round}: two faces with one key"
                );
            }
            assert_eq!(lap_surface_free(surface), LAP_OK);
            assert_eq!(lap_arrangement_free(arrangement), LAP_OK);
        }
        assert_eq!(lap_context_free(context), LAP_OK);
    }
    println!("{made} arrangements, {cells_on_planes} faces on planes; {refused} refused");
    assert!(made > refused && refused > 0 && cells_on_planes > made);
}
