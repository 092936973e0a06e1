//! Random input, good and bad, through the C functions: every call ends with a status of the documented ones and a handle
//! exactly on success; what is made passes its own check and adds up. Deterministic.

#[path = "common/random.rs"]
mod random;

use lapidary::capi::{
    context::*, cut::*, derived::*, grid::*, grid_boxes::*, grid_moments::*, keys::*, mesh::*, network::*,
    network_surface::*, network_views::*, status::*, surface::*,
};
use random::Random;
use std::ptr::{null, null_mut};

/// Small whole numbers nearly always, so that everything degenerate happens; now and then anything at all.
fn number(r: &mut Random, wild: u64) -> f64 {
    match r.below(64) {
        i if i < wild => f64::from_bits(r.bits()),
        i if i < 2 * wild => {
            [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN_POSITIVE, 5e-324, -0.0][r.below(7) as usize]
        }
        _ => r.below(7) as f64 - 3.0,
    }
}

const CUBE: [i32; 36] =
    [0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7];

/// A box, or two that may touch, cross or lie within one another, or a heap of random triangles.
fn soup(r: &mut Random) -> (Vec<f64>, Vec<i32>) {
    let wild = [0, 0, 0, 1, 4][r.below(5) as usize];
    let (mut xyz, mut indices) = (Vec::new(), Vec::new());
    if r.below(4) == 0 {
        for _ in 0..3 * r.below(10) {
            xyz.push(number(r, wild));
        }
        for _ in 0..3 * r.below(12) {
            indices.push(r.below(11) as i32 - 1);
        }
        return (xyz, indices);
    }
    for _ in 0..1 + r.below(2) {
        let first = (xyz.len() / 3) as i32;
        let low: [f64; 3] = std::array::from_fn(|_| number(r, wild));
        let size: [f64; 3] = std::array::from_fn(|_| 1.0 + r.below(4) as f64);
        for corner in [0, 1, 3, 2, 4, 5, 7, 6] {
            for axis in 0..3 {
                // Corners move now and then: skew boxes, which may turn inside out.
                let shift = if r.below(12) == 0 { number(r, wild) } else { 0.0 };
                xyz.push(low[axis] + size[axis] * f64::from(corner >> axis & 1) + shift);
            }
        }
        let inside_out = r.below(3) == 0;
        for t in CUBE.chunks(3) {
            let [a, b, c] = [t[0], t[1], t[2]].map(|v| v + first);
            indices.extend(if inside_out { [b, a, c] } else { [a, b, c] });
        }
    }
    if r.below(10) == 0 {
        let i = r.below(indices.len() as u64) as usize;
        indices[i] = r.below(20) as i32 - 2;
    }
    (xyz, indices)
}

#[test]
fn any_input_ends_with_a_status() {
    let mut r = Random(0x6c61_7069_6461_7279);
    let (mut meshes, mut cuts, mut bad, mut inconsistent, mut grids) = (0, 0, 0, 0, 0);
    unsafe {
        let mut context = null_mut();
        assert_eq!(lap_context_new(&mut context), LAP_OK);
        for round in 0..30000 {
            let (xyz, indices) = soup(&mut r);
            let (n, m) = ((xyz.len() / 3) as i64, (indices.len() / 3) as i64);
            let checked = r.below(2) == 0;
            let options = lap_mesh_options {
                struct_size: size_of::<lap_mesh_options>() as i32,
                merge_duplicate_vertices: r.below(2) as i32,
                check_self_intersection: checked as i32,
            };
            let mut mesh = null_mut();
            let status = lap_mesh_new(context, n, xyz.as_ptr(), m, indices.as_ptr(), null(), &options, &mut mesh);
            assert_eq!(status == LAP_OK, !mesh.is_null(), "round {round}");
            if status != LAP_OK {
                assert!([LAP_ERR_BAD_MESH, LAP_ERR_INCONSISTENT].contains(&status), "round {round}: {status}");
                assert!(!(checked && status == LAP_ERR_INCONSISTENT), "round {round}: checked, and yet inconsistent");
                let mut count = 0;
                assert_eq!(lap_context_last_defects(context, &mut count, null_mut(), null_mut()), LAP_OK);
                assert_eq!(count > 0, status == LAP_ERR_BAD_MESH, "round {round}");
                bad += 1;
                continue;
            }
            meshes += 1;
            grids += boxes(context, mesh, &mut r, checked, round);
            let wild = [0, 0, 1, 3][r.below(4) as usize];
            let planes: Vec<f64> = (0..4 * r.below(7)).map(|_| number(&mut r, wild)).collect();
            let mut cut = null_mut();
            let status = lap_cut_new(context, mesh, (planes.len() / 4) as i64, planes.as_ptr(), null(), &mut cut);
            assert_eq!(status == LAP_OK, !cut.is_null(), "round {round}");
            if status == LAP_OK {
                cuts += 1;
                consistent(context, mesh, cut, checked, round);
                assert_eq!(lap_cut_free(cut), LAP_OK);
            } else {
                assert!([LAP_ERR_BAD_PLANE, LAP_ERR_INCONSISTENT].contains(&status), "round {round}: {status}");
                assert!(!(checked && status == LAP_ERR_INCONSISTENT), "round {round}: checked, and yet inconsistent");
                inconsistent += (status == LAP_ERR_INCONSISTENT) as i32;
            }
            assert_eq!(lap_mesh_free(mesh), LAP_OK);
        }
        assert_eq!(lap_context_free(context), LAP_OK);
    }
    println!("{grids} grids");
    assert!(grids > 300);
    println!("{meshes} meshes, {bad} refused; {cuts} cuts, {inconsistent} of self-intersecting input refused");
    // The generator is worth something only if it gets everywhere.
    assert!(meshes > 500 && bad > 500 && cuts > 300);
}

/// What holds of any result, and of a result for checked input.
unsafe fn consistent(
    context: *mut lap_context,
    mesh: *const lap_mesh,
    cut: *const lap_cut,
    checked: bool,
    round: usize,
) {
    unsafe {
        let mut complex = null();
        assert_eq!(lap_cut_complex(cut, &mut complex), LAP_OK);
        let mut message = null();
        let status = lap_complex_check(context, complex);
        lap_context_last_error(context, null_mut(), &mut message);
        let message = std::ffi::CStr::from_ptr(message);
        // The geometry of self-intersecting input is unspecified, so areas and volumes may fail; the structure may not.
        assert!(status == LAP_OK || (status == LAP_ERR_INCONSISTENT && !checked), "round {round}: {message:?}");
        assert_eq!(lapidary::complex::check(&(*complex).data), Ok(()), "round {round}, checked: {checked}");
        let (mut cells, mut volumes, mut flags) = (0, null(), null());
        assert_eq!(lap_complex_cell_moments(complex, &mut cells, &mut volumes, null_mut(), &mut flags), LAP_OK);
        for style in [LAP_FACES_HOLES, LAP_FACES_BRIDGED, LAP_FACES_TRIANGLES] {
            let status = lap_complex_polygons(complex, style, null_mut(), null_mut(), null_mut(), null_mut());
            assert!(status == LAP_OK || (status == LAP_ERR_INCONSISTENT && !checked), "round {round}: style {style}");
        }
        let (mut count, mut keys) = (0, null::<i64>());
        assert_eq!(lap_complex_vertex_keys(complex, &mut count, &mut keys), LAP_OK);
        assert!((0..count as usize).all(|v| *keys.add(2 * v) >= 0), "round {round}: a negative key");
        let status = lap_complex_face_keys(complex, &mut count, &mut keys);
        assert!(status == LAP_OK || (status == LAP_ERR_INCONSISTENT && !checked), "round {round}: keys");
        let faces: Vec<[i64; 2]> = match status == LAP_OK {
            true => (0..count as usize).map(|f| [*keys.add(2 * f), *keys.add(2 * f + 1)]).collect(),
            false => Vec::new(),
        };
        let different: std::collections::BTreeSet<&[i64; 2]> = faces.iter().collect();
        assert!(!checked || different.len() == faces.len(), "round {round}: two faces with one key");
        let (mut output, mut input) = (0, 0);
        let status = lap_complex_euler(complex, &mut output, &mut input);
        assert!(status == LAP_OK || !checked, "round {round}");
        if !checked {
            return;
        }
        let volumes = std::slice::from_raw_parts(volumes, cells as usize);
        let flags = std::slice::from_raw_parts(flags, cells as usize);
        let bad = volumes.iter().zip(flags).find(|(v, f)| !(**v > 0.0 || **f != 0));
        assert!(cells > 0 && bad.is_none(), "round {round}: {bad:?} of {cells}");
        let mut whole = 0.0;
        assert_eq!(lap_mesh_volume(mesh, &mut whole), LAP_OK);
        // Near the end of the range the sum itself may overflow.
        if whole < f64::MAX / 4.0 && flags.iter().all(|f| *f == 0) {
            // Each within four units in the last place, and a rounding for each addition.
            let bound = 8.0 * f64::EPSILON * whole * (cells as f64 + 1.0);
            let sum = volumes.iter().sum::<f64>();
            assert!((sum - whole).abs() <= bound, "round {round}: {sum:e}, not {whole:e}: {volumes:?}");
        }
    }
}

/// Nodes that rise, nearly always; now and then they are anything.
fn nodes(r: &mut Random) -> Vec<f64> {
    let wild = [0, 0, 0, 0, 2][r.below(5) as usize];
    let mut all: Vec<f64> = (0..1 + r.below(6)).map(|_| number(r, wild) + 0.5 * r.below(2) as f64).collect();
    if r.below(20) > 0 {
        all.sort_unstable_by(f64::total_cmp);
        all.dedup();
    }
    all
}

/// Cuts a grid along the mesh, inside and outside; how many grids were made. Both together fill the grid, if the mesh is checked.
unsafe fn boxes(
    context: *mut lap_context,
    mesh: *const lap_mesh,
    r: &mut Random,
    checked: bool,
    round: usize,
) -> usize {
    unsafe {
        let [x, y, z] = [(); 3].map(|()| nodes(r));
        let rises = |n: &Vec<f64>| n.len() > 1 && n.iter().all(|x| x.is_finite()) && n.windows(2).all(|w| w[0] < w[1]);
        let valid = [&x, &y, &z].into_iter().all(rises);
        let (mut made, mut fluid, mut ordinary) = (0, 0.0, true);
        for outside in 0..2 {
            let mut options = std::mem::zeroed();
            assert_eq!(lap_grid_options_init(&mut options, size_of::<lap_grid_options>() as i32), LAP_OK);
            options.outside = outside;
            let mut grid = null_mut();
            let count = |n: &Vec<f64>| n.len() as i64;
            let status = lap_grid_new(
                context,
                mesh,
                count(&x),
                x.as_ptr(),
                count(&y),
                y.as_ptr(),
                count(&z),
                z.as_ptr(),
                &options,
                &mut grid,
            );
            assert_eq!(status == LAP_OK, !grid.is_null(), "round {round}");
            if status != LAP_OK {
                let expected = if valid { LAP_ERR_INCONSISTENT } else { LAP_ERR_BAD_ARGUMENT };
                let mut message = null();
                lap_context_last_error(context, null_mut(), &mut message);
                let message = std::ffi::CStr::from_ptr(message);
                assert_eq!(status, expected, "round {round}, checked: {checked}: {message:?}: {x:?} {y:?} {z:?}");
                assert!(!(checked && valid), "round {round}: checked, and yet inconsistent: {x:?} {y:?} {z:?}");
                return made;
            }
            assert!(valid, "round {round}: {x:?} {y:?} {z:?}");
            made += 1;
            let status = lap_grid_check(context, grid);
            assert!(status == LAP_OK || !checked, "round {round}: the check says {status}");
            let (mut n, mut volumes, mut flags, mut n_boxes, mut kinds) = (0, null(), null(), 0, null());
            let status = lap_grid_cell_moments(grid, &mut n, &mut volumes, null_mut(), null_mut(), &mut flags);
            assert_eq!(status, LAP_OK, "round {round}");
            assert_eq!(lap_grid_flags(grid, &mut n_boxes, &mut kinds), LAP_OK);
            for i in 0..n as usize {
                fluid += *volumes.add(i);
                ordinary &= *flags.add(i) == 0;
                assert!(*volumes.add(i) > 0.0 || *flags.add(i) != 0 || !checked, "round {round}: volume of cell {i}");
            }
            let width = |n: &[f64], i: usize| n[i + 1] - n[i];
            for b in (0..n_boxes as usize).filter(|&b| i32::from(*kinds.add(b)) == LAP_BOX_FULL) {
                let (nx, ny) = (x.len() - 1, y.len() - 1);
                fluid += width(&x, b % nx) * width(&y, b / nx % ny) * width(&z, b / (nx * ny));
            }
            assert_eq!(lap_grid_free(grid), LAP_OK);
        }
        let size = |n: &Vec<f64>| n[n.len() - 1] - n[0];
        let whole = size(&x) * size(&y) * size(&z);
        if checked && ordinary && whole > 1e-100 && whole < 1e100 {
            assert!((fluid - whole).abs() <= 1e-12 * whole, "round {round}: {fluid:e} of {whole:e}: {x:?} {y:?} {z:?}");
        }
        made
    }
}

/// Values that are zero, equal and opposite most of the time.
fn values(r: &mut Random, count: usize) -> Vec<f64> {
    let wild = [0, 0, 0, 0, 1][r.below(5) as usize];
    let fine = r.below(3) == 0;
    let mut one = |_| match r.below(64) {
        i if i < wild => {
            [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN_POSITIVE, 5e-324, -0.0][r.below(7) as usize]
        }
        _ if fine => (r.below(2001) as f64 - 1000.0) / 7.0,
        _ => r.below(3) as f64 - 1.0,
    };
    (0..count).map(&mut one).collect()
}

/// Random boxes, tetrahedra and triangles with random values: a status as documented, a network that passes its own check, both ways of
/// finding regions alike from values in any layout, the same boundary for a region and its complement, vertices that are the exact ones rounded.
#[test]
fn any_network_ends_with_a_status() {
    let mut r = Random(0x6e65_7477_6f72_6b73);
    let (mut made, mut bad, mut meshes) = (0, 0, 0);
    unsafe {
        let mut context = null_mut();
        assert_eq!(lap_context_new(&mut context), LAP_OK);
        for round in 0..3000 {
            let n = r.below(5) as usize;
            let mut options = std::mem::zeroed();
            assert_eq!(lap_network_options_init(&mut options, size_of::<lap_network_options>() as i32), LAP_OK);
            options.kind = r.below(2) as i32;
            options.keep_values = 1;
            let shape = r.below(3);
            let cells: [i32; 3] = std::array::from_fn(|_| r.below(25).min(3) as i32);
            let bounds: [f64; 6] = std::array::from_fn(|k| if k < 3 { -1.0 } else { r.below(40) as f64 });
            let nodes = match shape {
                0 => cells.iter().map(|&c| c as usize + 1).product(),
                _ => 4 + r.below(5) as usize,
            };
            let coordinates: Vec<f64> = (0..3 * nodes).map(|_| number(&mut r, (round % 9 == 0) as u64)).collect();
            // Fans of simplices around the first nodes: degenerate, overlapping and sound ones.
            let width = if shape == 1 { 4 } else { 3 };
            let mut corners: Vec<i32> = Vec::new();
            for k in 0..1 + r.below(3) as i32 {
                corners.extend((0..width).map(|c| if c + 1 < width { c } else { c + k }));
            }
            if r.below(12) == 0 {
                let at = r.below(corners.len() as u64) as usize;
                corners[at] = r.below(12) as i32 - 2;
            }
            let separate = values(&mut r, n * nodes);
            let interleaved: Vec<f64> = (0..n * nodes).map(|i| separate[i % n * nodes + i / n]).collect();
            let bad_stride = r.below(50) == 0;
            let make = |layout: usize, regions: i32| {
                let mut options = options;
                options.regions = regions;
                let mut network = null_mut();
                let (values, strides) = match layout {
                    0 => (separate.as_ptr(), [nodes as i64, 1]),
                    _ => (interleaved.as_ptr(), [1, n.max(1) as i64]),
                };
                let [a, b] = if bad_stride { [strides[0], -strides[1]] } else { strides };
                let count = (corners.len() / width as usize) as i64;
                let (n, nodes) = (n as i64, nodes as i64);
                let xyz = coordinates.as_ptr();
                let status = match shape {
                    0 => {
                        let bounds = if round % 2 == 0 { null() } else { bounds.as_ptr() };
                        lap_network_new_box(context, cells.as_ptr(), bounds, n, values, a, b, &options, &mut network)
                    }
                    1 => lap_network_new_tets(
                        context,
                        nodes,
                        xyz,
                        count,
                        corners.as_ptr(),
                        n,
                        values,
                        a,
                        b,
                        &options,
                        &mut network,
                    ),
                    _ => lap_network_new_triangles(
                        context,
                        nodes,
                        xyz,
                        count,
                        corners.as_ptr(),
                        n,
                        values,
                        a,
                        b,
                        &options,
                        &mut network,
                    ),
                };
                assert_eq!(status == LAP_OK, !network.is_null(), "round {round}");
                (status, network)
            };
            let (status, network) = make(0, LAP_REGIONS_AUTOMATIC);
            let (other_status, other) = make(1, LAP_REGIONS_CLASSES);
            assert_eq!(status, other_status, "round {round}");
            if status != LAP_OK {
                let mut message = null();
                lap_context_last_error(context, null_mut(), &mut message);
                let message = std::ffi::CStr::from_ptr(message);
                assert!([LAP_ERR_BAD_ARGUMENT, LAP_ERR_BAD_MESH].contains(&status), "round {round}: {message:?}");
                assert!(!message.is_empty(), "round {round}");
                bad += 1;
                continue;
            }
            made += 1;
            meshes += (shape > 0) as i32;
            assert!(!bad_stride && separate.iter().all(|x| x.is_finite()), "round {round}");
            let status = lap_network_check(context, network);
            let mut message = null();
            lap_context_last_error(context, null_mut(), &mut message);
            assert_eq!(status, LAP_OK, "round {round}: {:?}", std::ffi::CStr::from_ptr(message));
            let counts = |network| {
                let mut c = [0i64; 9];
                let [v, e, p, pa, ch, co, com, s, r] = &mut c;
                assert_eq!(lap_network_counts(network, v, e, p, pa, ch, co, com, s, r), LAP_OK);
                c
            };
            let c = counts(network);
            assert_eq!(c, counts(other), "round {round}");
            // Each region against the rest: the boundary of a solid and that of its complement are the same polygons.
            for region in 0..c[8] as usize {
                let mut table = vec![0u8; c[8] as usize];
                table[region] = 1;
                let complement: Vec<u8> = table.iter().map(|t| 1 - t).collect();
                let births = |table: &[u8]| {
                    let (mut surface, mut count, mut births) = (null_mut(), 0, null());
                    let status = lap_network_csg_table(context, network, c[8], table.as_ptr(), 0, &mut surface);
                    assert_eq!(status, LAP_OK);
                    let status =
                        lap_surface_polygons(surface, &mut count, null_mut(), null_mut(), &mut births, null_mut());
                    assert_eq!(status, LAP_OK);
                    let births: Vec<i32> = (0..count as usize).map(|i| *births.add(i)).collect();
                    assert_eq!(lap_surface_free(surface), LAP_OK);
                    births
                };
                assert_eq!(births(&table), births(&complement), "round {round}");
            }
            // Coordinates are the exact ones, rounded.
            let (mut count, mut xyz) = (0, null());
            assert_eq!(lap_network_vertices(network, &mut count, &mut xyz, null_mut()), LAP_OK);
            for v in (0..count as usize).take(4) {
                let mut texts = [null(); 3];
                let [x, y, z] = &mut texts;
                assert_eq!(lap_network_vertex_exact(context, network, v as i32, x, y, z), LAP_OK);
                for (k, text) in texts.iter().enumerate() {
                    let exact: rug::Rational = std::ffi::CStr::from_ptr(*text).to_str().unwrap().parse().unwrap();
                    let got = *xyz.add(3 * v + k);
                    let distance = |x: f64| (rug::Rational::from_f64(x).unwrap() - &exact).abs();
                    let nearest =
                        distance(got) <= distance(got.next_up()) && distance(got) <= distance(got.next_down());
                    assert!(nearest, "round {round}: {got} is not the double nearest to {exact}");
                }
            }
            assert_eq!(lap_network_free(network), LAP_OK);
            assert_eq!(lap_network_free(other), LAP_OK);
        }
        assert_eq!(lap_context_free(context), LAP_OK);
    }
    println!("{made} networks, {meshes} of them on meshes; {bad} refused");
    assert!(made > 1000 && meshes > 200 && bad > 100, "{made} {meshes} {bad}");
}
