//! Every moment equals the correctly rounded rational, computed from definitions.

#[path = "common/random.rs"]
mod random;

#[path = "common/complexes.rs"]
mod complexes;

use complexes::*;
use lapidary::base::{CellId, FaceId, VertexId};
use lapidary::complex::certified::Certified;
use lapidary::complex::exact_values::{
    cell_values, cell_volume, cell_volume_string, face_values, mesh_volume, vertex_strings,
};
use lapidary::complex::{Complex, Moments, moments};
use lapidary::exact::{Plane, round_rational};
use random::Random;
use rug::Rational;

/// Bitwise: −0 is not +0.
fn same(name: &str, what: &str, value: f64, exact: &Rational) {
    let expected = round_rational(exact);
    assert_eq!(value.to_bits(), expected.to_bits(), "{name}: {what} is {value:e}, not {expected:e}");
}

fn compare(name: &str, c: &Complex) -> Moments {
    let m = moments(c);
    for k in (0..c.cell_count()).map(CellId::of) {
        let (volume, centroid) = cell_by_tetrahedra(c, k);
        assert_eq!(volume, cell_volume(c, k), "{name}: exact volume of cell {}", k.0);
        assert_eq!((volume.clone(), centroid.clone()), cell_values(c, k), "{name}: exact values of cell {}", k.0);
        same(name, "volume", m.cell_volume[k.at()], &volume);
        for (x, exact) in m.cell_centroid[k.at()].iter().zip(&centroid) {
            same(name, "cell centroid", *x, exact);
        }
    }
    for f in (0..c.face_count()).map(FaceId::of) {
        let (area, centroid) = face_by_triangles(c, f);
        let exact = face_values(c, f);
        assert_eq!((&area, &centroid), (&exact.area, &exact.centroid), "{name}: exact values of face {}", f.0);
        for i in 0..3 {
            same(name, "area vector", m.face_area_vector[f.at()][i], &area[i]);
            same(name, "face centroid", m.face_centroid[f.at()][i], &centroid[i]);
        }
    }
    m
}

#[test]
fn small_complexes() {
    for (name, c) in all() {
        compare(name, &c);
    }
}

#[test]
fn volumes_add_up() {
    for (name, c) in all() {
        let sum = (0..c.cell_count()).fold(Rational::new(), |s, k| s + cell_volume(&c, CellId::of(k)));
        assert_eq!(sum, mesh_volume(&c.mesh), "{name}");
    }
}

fn random_plane(r: &mut Random) -> Plane {
    let n = [r.unit() - 0.5, r.unit() - 0.5, r.unit() - 0.5];
    let through = [6.0 * r.unit(), 6.0 * r.unit(), 6.0 * r.unit()];
    plane(n, -(n[0] * through[0] + n[1] * through[1] + n[2] * through[2]))
}

#[test]
fn random_planes() {
    let mut random = Random(88172645463325252);
    let (mut cells, mut rational) = (0, 0);
    for _ in 0..12 {
        let planes: Vec<Plane> = (0..4).map(|_| random_plane(&mut random)).collect();
        let c = cut_cube(&planes);
        let m = compare("random", &c);
        cells += m.cell_volume.len() + m.face_flags.len();
        rational += m.exact_cells + m.exact_faces;
    }
    println!("{cells} cells and faces, {rational} of them by rationals");
    assert!(rational * 20 < cells, "{rational} of {cells} by rationals");
}

/// Grid cells with 53-bit coordinates: a third of their centroids are ties, none of them may need rationals.
#[test]
fn grid_needs_no_rationals() {
    let mut random = Random(2463534242);
    let mut planes = Vec::new();
    for axis in 0..3 {
        for _ in 0..3 {
            let mut n = [0.0; 3];
            n[axis] = 1.0;
            planes.push(plane(n, -6.0 * random.unit()));
        }
    }
    let c = cut_cube(&planes);
    let m = compare("grid", &c);
    println!("{} cells, {} by rationals; {} faces, {}", c.cell_count(), m.exact_cells, c.face_count(), m.exact_faces);
    let inner: Vec<usize> = (0..c.cell_count()).filter(|&k| c.cell_faces(CellId::of(k)).len() == 6).collect();
    assert!(inner.len() >= 8 && m.exact_cells <= c.cell_count() - inner.len(), "boxes need none");
    let on_planes = c.face_cells.iter().filter(|k| k[1].is_some()).count();
    assert!(m.exact_faces < c.face_count() - on_planes, "faces on planes are parallelograms");
}

/// Slivers: planes an ulp apart.
#[test]
fn slivers() {
    let up = |x: f64| f64::from_bits(x.to_bits() + 1);
    let planes = [
        plane([1.0, 0.0, 0.0], -2.1),
        plane([1.0, 0.0, 0.0], -up(2.1)),
        plane([1.0, 1.0, 1.0], -6.3),
        plane([1.0, 1.0, up(1.0)], -6.3),
    ];
    compare("slivers", &cut_cube(&planes));
}

fn scaled(s: f64) -> Complex {
    let (v, t) = cuboid([s, 2.0 * s, -s], [3.0 * s, 3.0 * s, 1.5 * s], 0, false);
    convex_cut(mesh(&v, &t), &[plane([0.3, 0.5, 0.7], -2.0 * s), plane([1.0, 0.0, 0.0], -1.75 * s)])
}

/// Far beyond and far below: flagged, and rounded all the same.
#[test]
fn range() {
    let m = compare("huge", &scaled(1e200));
    assert!(m.cell_volume.iter().all(|v| v.is_infinite()));
    assert!(m.cell_flags.iter().all(|&f| f == 1));
    assert!(m.cell_centroid.iter().flatten().all(|x| x.is_finite()));
    let m = compare("tiny", &scaled(1e-200));
    assert!(m.cell_volume.iter().all(|v| v.to_bits() == 0));
    assert!(m.cell_flags.iter().all(|&f| f == 1) && m.face_flags.iter().all(|&f| f == 1));
    let m = compare("subnormal volumes", &scaled(1e-106));
    assert!(m.cell_volume.iter().all(|&v| v > 0.0 && !v.is_normal()));
    assert!(m.cell_flags.iter().all(|&f| f == 0));
    let m = compare("ordinary", &scaled(0.37));
    assert!(m.cell_flags.iter().chain(&m.face_flags).all(|&f| f == 0));
}

#[test]
fn strings_are_canonical() {
    let c = cut_cube(&[plane([3.0, 0.0, 0.0], -5.0), plane([0.0, -2.0, 0.0], 3.0), plane([0.0, 0.0, 1.0], 0.0)]);
    let mut seen = Vec::new();
    for v in (0..c.vertex_count()).map(VertexId::of) {
        seen.extend(vertex_strings(&c, v));
    }
    seen.sort();
    seen.dedup();
    assert_eq!(seen, ["0", "3/2", "5/3", "6"]);
    let mut volumes: Vec<String> = (0..c.cell_count()).map(|k| cell_volume_string(&c, CellId::of(k))).collect();
    volumes.sort();
    assert_eq!(volumes, ["117", "15", "39", "45"]);
}

#[test]
fn threads_change_nothing() {
    let c = cut_cube(&[plane([0.3, 0.7, -0.2], -1.9), plane([1.7, -0.4, 0.9], -4.1)]);
    let on = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap().install(|| moments(&c));
    assert_eq!(on(1), on(3));
}

/// The bound of every operation, against rationals; and an operation that is exact knows it.
#[test]
fn certified_bounds() {
    let mut random = Random(123456789);
    let rational = |x: f64| Rational::from_f64(x).unwrap();
    let exact = |c: &Certified| rational(c.hi) + rational(c.lo);
    let mut exactly = 0;
    for round in 0..20000 {
        let mut pick = |bits: u64| {
            let m = (random.bits() >> (64 - bits)) as f64;
            let s = if random.bits() & 1 == 1 { -1.0 } else { 1.0 };
            s * m * 2f64.powi((random.bits() % 40) as i32 - 20)
        };
        // Few bits: everything is exact. Many: nothing is.
        let bits = [5, 24, 53][round % 3];
        let (a, b, d, e) = (pick(bits), pick(bits), pick(bits), pick(bits));
        let (x, y) = (Certified::difference(a, b), Certified::difference(d, e));
        let (p, q) = (rational(a) - rational(b), rational(d) - rational(e));
        let mut values = vec![
            (x + y, Rational::from(&p + &q)),
            (x - y, Rational::from(&p - &q)),
            (x * y, Rational::from(&p * &q)),
            (x.times(d), &p * rational(d)),
            (x * y + y * x - x, Rational::from(&p * &q) * 2 - &p),
        ];
        if !q.is_zero() {
            values.push((x / y, Rational::from(&p / &q)));
            values.push((x * y / y, p.clone()));
        }
        for (c, r) in values {
            let off = (exact(&c) - &r).abs();
            assert!(off <= rational(c.err), "{c:?} is not {r}");
            assert!(c.err <= c.hi.abs() * 1e-29 || c.err <= f64::MIN_POSITIVE || bits == 53 || c.hi == 0.0, "{c:?}");
            if let Some(v) = c.rounded() {
                assert_eq!(v.to_bits(), round_rational(&r).to_bits());
            }
            if let Some(s) = c.sign() {
                assert_eq!(s as i32, r.cmp0() as i32);
            }
            exactly += (c.err == 0.0) as usize;
        }
    }
    assert!(exactly > 30000, "{exactly} exact operations");
}
