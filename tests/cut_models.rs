//! Every closed valid mesh of the optional CGAL data set under every kind of plane set: the complex is what it claims
//! to be, its Euler characteristic is the solid's, and the cells' exact volumes add up to the solid's.
//!
//! A quick subset by default; all with `LAPIDARY_ALL=1 cargo test --release --test cut_models`.

mod common;

use common::models::{arbitrary, each_model, grid, incident, on_integers};
use common::random::Random;
use lapidary::base::Run;
use lapidary::complex::{check, check_volumes, euler, solid_euler};
use lapidary::cut::{CutOptions, cut};
use lapidary::exact::Plane;
use lapidary::mesh::TriMesh;
use std::sync::Arc;

fn verify(name: &str, what: &str, mesh: &Arc<TriMesh>, planes: &[Plane], failed: &mut Vec<String>) {
    let outcome =
        cut(mesh, planes, &CutOptions::default(), &mut Run::quiet()).map_err(|e| e.message).and_then(|result| {
            check(&result.complex)?;
            check_volumes(&result.complex)?;
            let (got, wanted) = (euler(&result.complex)?, solid_euler(mesh));
            if got == wanted { Ok(()) } else { Err(format!("Euler characteristic {got}, expected {wanted}")) }
        });
    if let Err(message) = outcome {
        println!("{name} {what}: {message}");
        failed.push(format!("{name} {what}: {message}"));
    }
}

#[test]
fn all_plane_sets_on_real_models() {
    let everything = std::env::var_os("LAPIDARY_ALL").is_some();
    let (mut failed, mut runs, mut exact) = (Vec::new(), 0, 0);
    let there = each_model(3000, |name, soup, mesh| {
        let mut random = Random(soup.triangles.len() as u64);
        let mut sets = vec![
            ("A5", grid(&mesh, 5)),
            ("A10", grid(&mesh, 10)),
            ("R10", arbitrary(&mesh, 10, &mut random)),
            ("R30", arbitrary(&mesh, 30, &mut random)),
            ("incident", incident(&mesh, 6, &mut random)),
            ("box", grid(&mesh, 2)),
        ];
        if everything || soup.triangles.len() < 500 {
            sets.push(("R100", arbitrary(&mesh, 100, &mut random)));
        }
        for (what, planes) in &sets {
            verify(name, what, &mesh, planes, &mut failed);
            runs += 1;
        }
        if let Some(mesh) = on_integers(soup) {
            let mesh = Arc::new(mesh);
            for what in ["integers 1", "integers 2"] {
                verify(name, what, &mesh, &incident(&mesh, 6, &mut random), &mut failed);
                (runs, exact) = (runs + 1, exact + 1);
            }
        }
    });
    if !there {
        return;
    }
    println!("{runs} cuts, {exact} of them with planes exactly through edges and faces");
    assert!(runs > 100 && exact > 20);
    assert!(failed.is_empty(), "{failed:#?}");
}
