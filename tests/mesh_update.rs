//! Moved coordinates on the same connectivity give what a fresh mesh gives, or leave everything as it was.

mod common;
use common::random::Random;
use common::*;
use lapidary::base::{DefectKind::*, Run, Status};
use lapidary::mesh::{MeshOptions, TriMesh, update_coordinates};
use std::sync::Arc;

/// Every array of a mesh.
fn all(mesh: &TriMesh) -> String {
    format!("{mesh:?}")
}

fn update(mesh: &mut Arc<TriMesh>, vertices: &[[f64; 3]], options: MeshOptions) -> Result<(), lapidary::base::Error> {
    update_coordinates(mesh, vertices, &options, &mut Run::quiet())
}

/// Two boxes with a common edge, one of them with a void, in which there is a third.
fn solids() -> Soup {
    let mut soup = together(&[
        cuboid([0.0; 3], [8.0; 3]),
        cuboid([8.0, 8.0, 0.0], [12.0, 12.0, 8.0]),
        flipped(cuboid([1.0; 3], [7.0; 3])),
        cuboid([3.0; 3], [4.0; 3]),
    ]);
    // One vertex for each place, by hand: the connectivity is that of the indices.
    let merged = build_soup(&soup, merging()).unwrap();
    soup.vertices = merged.vertices.clone();
    soup.triangles = merged.triangles.iter().map(|t| t.map(|v| v.0 as i32)).collect();
    soup
}

#[test]
fn equal_to_a_fresh_mesh_in_every_array() {
    let soup = solids();
    for threads in [1, 3] {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| {
            let mut mesh = Arc::new(build_soup(&soup, plain()).unwrap());
            assert!(
                mesh.shells.len() == 4 && mesh.component_count == 3 && mesh.shells.iter().any(|s| s.anchor.is_some())
            );
            let mut random = Random(7);
            for round in 0..20 {
                // A skew map and little moves of each vertex; -0 among the coordinates.
                let k = round as f64 * 0.125;
                let mut moved = soup.clone();
                for x in &mut moved.vertices {
                    let small = || 0.01;
                    *x = [x[0] + k * x[1], -x[1], -x[2] - k].map(|c| c + small() * random.unit());
                    if round == 3 {
                        x[0] = if x[0] < 0.02 { -0.0 } else { x[0] };
                    }
                }
                let check = if round % 2 == 0 { checking() } else { plain() };
                let fresh = build_soup(&moved, check);
                let before = all(&mesh);
                match (update(&mut mesh, &moved.vertices, check), fresh) {
                    (Ok(()), Ok(fresh)) => {
                        mesh.check().unwrap();
                        assert_eq!(all(&mesh), all(&fresh), "round {round}");
                    }
                    (Err(found), Err(expected)) => {
                        assert_eq!((found.status, found.culprits), (expected.status, expected.culprits));
                        assert_eq!(all(&mesh), before);
                    }
                    (found, fresh) => panic!("round {round}: {found:?}, {:?}", fresh.map(|_| ())),
                }
            }
            // Back to the start, and to powers of two of it.
            for scale in [1.0, 0.5, 1024.0] {
                let mut scaled = soup.clone();
                scaled.vertices.iter_mut().for_each(|x| *x = x.map(|c| c * scale));
                update(&mut mesh, &scaled.vertices, checking()).unwrap();
                assert_eq!(all(&mesh), all(&build_soup(&scaled, plain()).unwrap()));
            }
        });
    }
}

#[test]
fn a_mesh_that_is_held_elsewhere_stays_as_it_is_there() {
    let soup = solids();
    let mut mesh = Arc::new(build_soup(&soup, plain()).unwrap());
    let held = mesh.clone();
    let before = all(&held);
    let moved: Vec<[f64; 3]> = soup.vertices.iter().map(|x| x.map(|c| 3.0 * c + 1.0)).collect();
    update(&mut mesh, &moved, plain()).unwrap();
    assert_eq!(all(&held), before);
    assert_eq!(mesh.vertices, moved);
    assert!(!Arc::ptr_eq(&mesh, &held));
    // Alone again, it is changed in place.
    drop(held);
    let (place, edges) = (Arc::as_ptr(&mesh), mesh.edges.as_ptr());
    update(&mut mesh, &soup.vertices, plain()).unwrap();
    assert_eq!((Arc::as_ptr(&mesh), mesh.edges.as_ptr()), (place, edges));
    assert_eq!(all(&mesh), before);
}

#[test]
fn defects_leave_the_mesh_unchanged() {
    let soup = solids();
    let mut mesh = Arc::new(build_soup(&soup, plain()).unwrap());
    let before = all(&mesh);
    let mut refused = |change: &dyn Fn(&mut Vec<[f64; 3]>), options: MeshOptions| {
        let mut vertices = soup.vertices.clone();
        change(&mut vertices);
        let error = update(&mut mesh, &vertices, options).expect_err("refused");
        assert_eq!(all(&mesh), before);
        error
    };
    let error = refused(&|v| v[3][1] = f64::NAN, plain());
    assert_eq!(error.culprits[0], culprit(NonFiniteCoordinate, &[3]));
    let error = refused(&|v| v[1] = v[0], plain());
    assert!(error.culprits.contains(&culprit(DuplicateVertex, &[0, 1])));
    assert!(error.culprits.iter().any(|c| c.kind == DegenerateTriangle));
    let error = refused(&|v| v.iter_mut().for_each(|x| x[0] = -x[0]), plain());
    assert!(error.culprits.iter().all(|c| c.kind == WrongNesting) && !error.culprits.is_empty());
    // The box inside sticks out of the void.
    let error = refused(&|v| v.iter_mut().filter(|x| x[0] == 4.0).for_each(|x| x[0] = 7.5), checking());
    assert!(error.culprits.iter().all(|c| c.kind == SelfIntersection) && !error.culprits.is_empty());
    let error = refused(&|v| v.truncate(5), plain());
    assert_eq!(error.status, Status::BadArgument);
}

fn plain() -> MeshOptions {
    MeshOptions::default()
}
