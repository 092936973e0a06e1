//! The polygons in the active simplices of a mesh, in the order of the simplices.

use super::mesh_edges::{MeshEdges, active_word, bits};
use super::polygons::{Active, Context, Pieces, Simplex, arrangement_polygons, interface_polygons};
use super::signs::{Label, NodeSigns};
use super::tet_mesh::TetMesh;
use crate::base::parallel::map_ranges;
use crate::base::{FunctionId, NodeId};
use crate::exact::Sign;

/// Active simplices in one task at least.
const LEAST: usize = 1 << 11;

fn each(mesh: &TetMesh, edges: &MeshEdges, body: impl Fn(usize, &Simplex, &mut Pieces) + Sync) -> Vec<Pieces> {
    map_ranges(edges.active.len(), LEAST, |range| {
        let mut out = Pieces::default();
        for at in range {
            let tet = edges.active[at];
            let positive = mesh.orientation(tet) == Sign::Positive;
            body(at, &Simplex { dim: mesh.dim, tet, nodes: mesh.tets[tet.at()], positive }, &mut out);
        }
        out
    })
}

/// Those of an arrangement.
pub fn arrangement_cells(mesh: &TetMesh, context: &Context, signs: &NodeSigns, edges: &MeshEdges) -> Vec<Pieces> {
    each(mesh, edges, |at, s, out| {
        let nodes = &s.nodes[..=s.dim];
        let mut active = std::mem::take(&mut out.active_functions);
        active.clear();
        for w in 0..signs.words {
            for f in bits(active_word(signs, nodes, w, context.values.len())) {
                let (mut positive, mut negative) = (0u8, 0u8);
                for (c, &n) in nodes.iter().enumerate() {
                    let s = signs.of(n)[w];
                    positive |= ((s.positive >> f & 1) as u8) << c;
                    negative |= ((s.negative >> f & 1) as u8) << c;
                }
                active.push(Active { function: FunctionId::of(w * 64 + f), positive, negative });
            }
        }
        out.count_active(active.len(), 1);
        arrangement_polygons(context, s, &active, |e| edges.span(at, e), out);
        out.active_functions = active;
    })
}

/// Those of an interface.
pub fn interface_cells(mesh: &TetMesh, context: &Context, labels: &[Label], edges: &MeshEdges) -> Vec<Pieces> {
    each(mesh, edges, |at, s, out| {
        let nodes = &s.nodes[..=s.dim];
        let mut materials = std::mem::take(&mut out.materials);
        materials.clear();
        let below =
            |f: FunctionId, g: FunctionId| nodes.iter().all(|&n| context.values.at(f, n) < context.values.at(g, n));
        // Most are exceeded by one that is the largest at some corner.
        for f in (0..context.values.len()).map(FunctionId::of) {
            if !nodes.iter().any(|n: &NodeId| below(f, labels[n.at()].material())) {
                materials.push(f);
            }
        }
        let mut k = 0;
        while k < materials.len() {
            // Whoever exceeds a material need not be in the list any more, but then a greater one is.
            if materials.iter().any(|&g| below(materials[k], g)) {
                materials.remove(k);
            } else {
                k += 1;
            }
        }
        if materials.len() >= 2 {
            out.count_active(materials.len(), 1);
            interface_polygons(context, s, &materials, |e| edges.span(at, e), out);
        }
        out.materials = materials;
    })
}
