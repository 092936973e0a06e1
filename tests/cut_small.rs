//! Small and nasty cutting cases with exact results computed by other means (`tests/data/cut-small`).

mod common;

use lapidary::base::{FaceId, Run};
use lapidary::complex::{Complex, SupportId};
use lapidary::cut::{Cut, CutOptions, cut};
use lapidary::exact::Plane;
use rug::Rational;
use std::path::Path;
use std::sync::Arc;

fn planes_of(case: &serde_json::Value) -> Vec<Plane> {
    let row = |p: &serde_json::Value| {
        let x: Vec<f64> = p.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
        Plane { n: [x[0], x[1], x[2]], d: x[3] }
    };
    case["planes"].as_array().unwrap().iter().map(row).collect()
}

/// Six times the volume of each cell, straight from the definition: tetrahedra from the origin over fans of the loops.
fn volumes(c: &Complex) -> Vec<Rational> {
    let x: Vec<[Rational; 3]> =
        (0..c.vertex_count()).map(|v| lapidary::exact::rational(&c.point(lapidary::base::VertexId::of(v)))).collect();
    let mut sums = vec![Rational::new(); c.cell_count()];
    for f in 0..c.face_count() {
        let mut six = Rational::new();
        for l in c.loops_of(FaceId::of(f)) {
            let corners = &c.corner_vertices[c.corners_of(l)];
            for k in 2..corners.len() {
                let [p, q, r] = [corners[0], corners[k - 1], corners[k]].map(|v| &x[v.at()]);
                for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
                    six += p[i].clone() * (q[j].clone() * &r[k] - q[k].clone() * &r[j]);
                }
            }
        }
        let [owner, neighbour] = c.face_cells[f];
        sums[owner.at()] += &six;
        if neighbour.is_some() {
            sums[neighbour.at()] -= &six;
        }
        assert_eq!(neighbour.is_some(), matches!(c.face_support[f], SupportId::Plane(_)));
    }
    sums.into_iter().map(|six| six / 6).collect()
}

fn run_case(path: &Path) -> Result<(), String> {
    let case: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let soup = common::read_obj(&path.with_file_name(case["mesh"].as_str().unwrap()))?;
    let mesh = Arc::new(common::build_soup(&soup, Default::default()).map_err(|e| e.message)?);
    let Cut { complex, .. } =
        cut(&mesh, &planes_of(&case), &CutOptions::default(), &mut Run::quiet()).map_err(|e| e.message)?;
    let expect = |what: &str, got: usize, key: &str| match case[key].as_u64() {
        Some(n) if n as usize != got => Err(format!("{got} {what}, expected {n}")),
        Some(_) => Ok(()),
        None => Err(format!("{key} is not in the case")),
    };
    expect("cells", complex.cell_count(), "cells")?;
    expect("new vertices", complex.vertex_count() - mesh.vertices.len(), "distinct_new_vertices")?;
    let mut got = volumes(&complex);
    got.sort();
    let text = |v: &serde_json::Value| v.as_str().unwrap().parse::<Rational>().unwrap();
    let total: Rational = got.iter().fold(Rational::new(), |sum, v| sum + v);
    if total != text(&case["total_volume_exact"]) {
        return Err("the total volume differs".into());
    }
    match case["volumes_sorted_exact"].as_array() {
        Some(wanted) if wanted.iter().map(text).ne(got.iter().cloned()) => return Err("volumes differ".into()),
        Some(_) => {}
        // Some cases give the exact total and the cells' volumes as the nearest doubles.
        None => {
            let wanted: Vec<f64> =
                case["volumes_sorted"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
            let rounded: Vec<f64> = got.iter().map(lapidary::exact::round_rational).collect();
            if wanted != rounded {
                return Err(format!("rounded volumes differ: {rounded:?}, expected {wanted:?}"));
            }
        }
    }
    Ok(())
}

#[test]
fn small_cases_are_exact() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/cut-small");
    let mut cases: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    cases.retain(|p| p.extension().is_some_and(|e| e == "json"));
    cases.sort();
    assert_eq!(cases.len(), 25);
    let failed: Vec<String> = cases
        .iter()
        .filter_map(|p| run_case(p).err().map(|e| format!("{}: {e}", p.file_stem().unwrap().to_string_lossy())))
        .collect();
    assert!(failed.is_empty(), "{failed:#?}");
}
