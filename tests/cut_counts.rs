//! Counts of cells, edges and faces on real models, against those that the TopoCut paper's own program gives
//! (`oracles/cut-counts.json` of the optional shared data; meshes of the optional CGAL data set).

mod common;

use lapidary::base::Run;
use lapidary::cut::{CutOptions, cut};
use lapidary::exact::Plane;
use std::sync::Arc;

#[test]
fn counts_on_real_models() {
    let (Some(file), Some(folder)) = (common::shared("oracles/cut-counts.json"), common::cgal_meshes()) else {
        return;
    };
    let all: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
    let cases = all["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 45);
    let mut failed = Vec::new();
    for case in cases {
        let name = case["mesh"].as_str().unwrap();
        let soup = match name.starts_with("x_") {
            true => common::read_obj(
                &common::shared(&format!("data/meshes/{}.obj", &name[2..].trim_end_matches(".off"))).unwrap(),
            ),
            false => common::read_off(&folder.join(name)),
        };
        let soup = soup.unwrap();
        let planes: Vec<Plane> = case["planes"]
            .as_array()
            .unwrap()
            .iter()
            .map(|p| {
                let x: Vec<f64> = p.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
                Plane { n: [x[0], x[1], x[2]], d: x[3] }
            })
            .collect();
        let start = std::time::Instant::now();
        let mesh = Arc::new(common::build_soup(&soup, Default::default()).unwrap());
        let built = start.elapsed().as_secs_f64();
        let result = match cut(&mesh, &planes, &CutOptions::default(), &mut Run::quiet()) {
            Ok(result) => result,
            Err(e) => {
                failed.push(format!("{name} {}: {}", case["set"], e.message));
                continue;
            }
        };
        let c = &result.complex;
        let holes = (0..c.face_count()).any(|f| c.face_loops[f + 1] - c.face_loops[f] > 1);
        let got = (c.edge_count(), c.face_count(), c.cell_count());
        let number = |key: &str| case[key].as_u64().unwrap() as usize;
        let wanted = (number("edges"), number("faces"), number("cells"));
        println!(
            "{name} {}: {got:?} holes {holes}, mesh {:.1} ms, cut {:.1} ms",
            case["set"],
            built * 1e3,
            start.elapsed().as_secs_f64() * 1e3 - built * 1e3
        );
        if got.2 != wanted.2 || (!holes && got != wanted) {
            failed.push(format!("{name} {}: {got:?}, expected {wanted:?}, holes {holes}", case["set"]));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}
