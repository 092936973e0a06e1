//! Small complexes pass every check, and each kind of damage is found.

#[path = "common/complexes.rs"]
mod complexes;

use complexes::*;
use lapidary::base::{CellId, Csr, EdgeId, PlaneId, VertexId};
use lapidary::complex::check::check_exact;
use lapidary::complex::{Complex, Origin, check, check_volumes, euler, solid_euler};

#[test]
fn small_complexes_pass() {
    for (name, c) in all() {
        assert_eq!(check(&c), Ok(()), "{name}");
        assert_eq!(check_volumes(&c), Ok(()), "{name}");
        assert_eq!(check_exact(&c), Ok(()), "{name}");
    }
}

#[test]
fn euler_of_known_solids() {
    let known = |name: &str| match name {
        "cube with void" | "square hole" | "touching vertex" | "touching edge" => 2,
        "ring" | "ring in two" => 0,
        _ => 1,
    };
    for (name, c) in all() {
        assert_eq!(solid_euler(&c.mesh), known(name), "{name}: the mesh");
        assert_eq!(euler(&c), Ok(known(name)), "{name}: the complex");
    }
}

/// Solids that touch themselves along edges and at vertices: the number of umbrellas and wedges matters.
#[test]
fn euler_of_touching_boxes() {
    // Two boxes that share an edge; two that share a vertex; three in a chain of edge contacts.
    let cases: [(&[[i32; 3]], i64); 4] = [
        (&[[0, 0, 0], [1, 1, 0]], 1),
        (&[[0, 0, 0], [1, 1, 1]], 1),
        (&[[0, 0, 0], [1, 1, 0], [2, 0, 0]], 1),
        // Four around an empty square touch in a ring of edges.
        (&[[1, 0, 0], [0, 1, 0], [2, 1, 0], [1, 2, 0]], 0),
    ];
    for (boxes, expected) in cases {
        let mesh = voxels(&|p| boxes.contains(&p), 4);
        assert_eq!(solid_euler(&mesh), expected, "{boxes:?}");
    }
    // A ball whose boundary touches itself along an edge: a bent bar of boxes.
    let bent = [[0, 0, 0], [0, 0, 1], [0, 1, 1], [1, 1, 1], [1, 1, 0]];
    let mesh = voxels(&|p| bent.contains(&p), 3);
    let c = uncut(mesh);
    assert_eq!(check(&c), Ok(()));
    assert_eq!(euler(&c), Ok(solid_euler(&c.mesh)));
    assert!(shared_edges(&c) == 1, "one edge is met twice by the same cell");
}

/// Edges with four uses.
fn shared_edges(c: &Complex) -> usize {
    let count = |e: EdgeId| c.corner_edges.iter().filter(|&&x| x == e).count();
    (0..c.edge_count()).filter(|&e| count(EdgeId::of(e)) == 4).count()
}

fn damaged(name: &str, damage: impl Fn(&mut Complex), expected: &str) {
    let mut c = cube_in_two();
    assert_eq!(check(&c), Ok(()), "before: {name}");
    damage(&mut c);
    let result = check(&c).and_then(|_| check_volumes(&c)).and_then(|_| check_exact(&c));
    let message = result.expect_err(name);
    assert!(message.contains(expected), "{name}: {message}");
}

#[test]
fn damage_is_found() {
    damaged("vertex out of range", |c| c.corner_vertices[3] = VertexId(99), "range");
    damaged("edge out of range", |c| c.corner_edges[3] = EdgeId(99), "range");
    damaged("cell out of range", |c| c.face_cells[0][0] = CellId(99), "range");
    damaged("no edge", |c| c.corner_edges[3] = EdgeId::NONE, "without an edge");
    damaged("wrong edge", |c| c.corner_edges.swap(0, 1), "does not");
    damaged("unused edge", |c| c.edges.push([VertexId(0), VertexId(1)]), "is in no face");
    damaged("no owner", |c| c.face_cells[0][0] = CellId::NONE, "no owner");
    damaged("two cells at a triangle", |c| c.face_cells[0][1] = CellId(1 - c.face_cells[0][0].0), "two cells");
    damaged("sides exchanged", |c| c.face_cells.last_mut().unwrap().swap(0, 1), "not the cell's");
    damaged("tag", |c| c.face_tag[0] = 7, "tag");
    damaged("face twice in a shell", |c| c.shell_faces.items[1] = c.shell_faces.items[0], "rising");
    damaged("planes", |c| c.vertex_planes = Csr::from_pairs(c.vertex_count(), std::iter::empty()), "origin");
    damaged("plane of a face", |c| *c.face_plane.last_mut().unwrap() = PlaneId::NONE, "another plane");
    damaged("coordinate", |c| c.coords.last_mut().unwrap()[0] = 0.5, "");
    damaged("plane moved", |c| c.planes[0].d = -1.5, "");
    damaged(
        "same origin",
        |c| {
            let i = c.origins.iter().position(|o| matches!(o, Origin::Edge(..))).unwrap();
            let j = c.origins.iter().rposition(|o| matches!(o, Origin::Edge(..))).unwrap();
            c.origins[i] = c.origins[j];
        },
        "",
    );
}

/// A face removed together with its half-face leaves an open shell.
#[test]
fn open_shell_is_found() {
    let mut c = cube();
    let last = c.face_count() - 1;
    c.face_loops.pop();
    c.loop_offsets.pop();
    let end = *c.loop_offsets.last().unwrap() as usize;
    c.corner_vertices.truncate(end);
    c.corner_edges.truncate(end);
    c.face_support.truncate(last);
    c.face_plane.truncate(last);
    c.face_tag.truncate(last);
    c.face_cells.truncate(last);
    c.shell_faces.items.pop();
    *c.shell_faces.offsets.last_mut().unwrap() -= 1;
    let message = check(&c).unwrap_err();
    assert!(message.contains("open at edge"), "{message}");
}
