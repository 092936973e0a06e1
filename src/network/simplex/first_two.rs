//! The complex that the first two of many functions make, from the look-up table into the working arenas: the construction goes on
//! with the third one, having saved about half of what three functions take.
//!
//! Only for two functions in general position on the corners' span: no corner value is zero, and no two points on an edge of the
//! simplex are the same. Then every vertex has exactly the planes of its encoding, every edge exactly two, and nothing of what the arenas
//! note about ties is there. All others start from the simplex alone. (Taking ties along would save nothing that matters:
//! where functions vanish at corners the construction has less to do.)
//!
//! Cost: linear in the entry, of at most four cells; one rule of Cramer for each new vertex.

use super::arrangement::NOWHERE;
use super::data::FaceSupport;
use super::table_view::View;
use super::tables::{ENTRIES, Entry, Table, find_arrangement_2};
use super::work::{Cell, EDGE_CORNERS, Edge, FACETS, Face, NONE, Work};

/// Whether an entry is one of two functions in a tetrahedron in general position.
static GENERAL: [bool; ENTRIES.len()] = {
    let mut out = [false; ENTRIES.len()];
    let mut i = 0;
    while i < ENTRIES.len() {
        out[i] = general(&ENTRIES[i]);
        i += 1;
    }
    out
};

const fn general(entry: &Entry) -> bool {
    let Table { dim, functions, types, .. } = entry.table;
    // (Only arrangements of two functions have nine types.)
    if dim != 3 || functions != 2 || types != 9 || entry.zero != 0 {
        return false;
    }
    let mut v = 0;
    while v < entry.vertices.len() {
        let vertex = &entry.vertices[v];
        if vertex.functions.count_ones() + 1 != vertex.carrier.count_ones() {
            return false;
        }
        v += 1;
    }
    true
}

/// By carrier, and the functions that vanish there: the planes, rising; the rest is [`NONE`].
static PLANES: [[[u32; 4]; 4]; 16] = {
    let mut out = [[[NONE; 4]; 4]; 16];
    let mut i = 0;
    while i < 64 {
        let (carrier, functions) = (i / 4, i % 4);
        let all = !carrier & 15 | functions << FACETS;
        let (mut n, mut p) = (0, 0);
        while p < 6 && n < 4 {
            if all >> p & 1 == 1 {
                out[carrier][functions][n] = p as u32;
                n += 1;
            }
            p += 1;
        }
        i += 1;
    }
    out
};

/// The number of the simplex's edge with these two corners; 6 for all other sets.
static EDGE_OF: [u8; 16] = {
    let mut out = [6; 16];
    let mut e = 0;
    while e < 6 {
        let [a, b] = EDGE_CORNERS[e];
        out[1 << a | 1 << b] = e as u8;
        e += 1;
    }
    out
};

impl Work {
    /// Begins ([`Work::start`] has been called, for an arrangement in a tetrahedron) with the complex of functions 0 and 1, if they are
    /// in general position.
    pub fn enter_first_two(&mut self) -> bool {
        #[cfg(feature = "plain-signs")]
        if self.plain {
            // Tables would know better.
            return false;
        }
        let [f, g] = [self.values[0], self.values[1]];
        if [f, g].as_flattened().contains(&0.0) {
            return false;
        }
        let found = find_arrangement_2(&f, &g);
        if !GENERAL[found.entry as usize] {
            return false;
        }
        let view = View::new(found);
        self.round = 2;
        for v in 4..view.entry.vertices.len() {
            let (carrier, functions) = view.vertex(v as u8);
            self.new_vertex(carrier.0, PLANES[carrier.0 as usize & 15][functions as usize & 3]);
        }
        self.enter_edges(&view);
        let turned = self.enter_faces(&view);
        self.enter_cells(&view, turned);
        for (k, values) in (0..).zip([f, g]) {
            let crosses = values.iter().any(|&x| x > 0.0) && values.iter().any(|&x| x < 0.0);
            self.function_plane.push(if crosses { k + FACETS } else { NOWHERE });
            self.function_opposite.push(false);
        }
        true
    }

    fn enter_edges(&mut self, view: &View) {
        // Of each edge of the simplex (and, unused, of all others): the parts at its lower corner, between, at its higher corner.
        let mut parts = [[NONE; 3]; 7];
        self.edges.extend(view.entry.edges.iter().zip(0u32..).map(|(&ends, e)| {
            let (carrier, functions) = view.between(ends);
            let carrier = carrier.0 as usize & 15;
            let mut ends = ends.map(|v| view.number(v).0);
            let on = EDGE_OF[carrier] as usize;
            if on < 6 {
                // Ends are in the order of the simplex's edge; those of the part between will be.
                let [low, high] = EDGE_CORNERS[on];
                if ends[0] == high || ends[1] == low {
                    ends.swap(0, 1);
                }
                let place = if ends[0] == low { 0 } else { 1 + (ends[1] == high) as usize };
                parts[on][place] = e;
            }
            let [p, q, ..] = PLANES[carrier][functions as usize & 3];
            Edge { ends, planes: [p, q, NONE], mark: 0, next: NONE, face: NONE }
        }));
        for (on, [low, middle, high]) in parts.into_iter().take(6).enumerate() {
            self.first_part[on] = low;
            self.edges[low as usize].next = if middle == NONE { high } else { middle };
            if middle != NONE {
                let first = self.edges[low as usize].ends[1];
                let edge = &mut self.edges[middle as usize];
                if edge.ends[0] != first {
                    edge.ends.swap(0, 1);
                }
                edge.next = high;
            }
        }
    }

    /// Returns the faces whose sides are not those of the entry's.
    fn enter_faces(&mut self, view: &View) -> u64 {
        self.corners.resize(view.entry.corners.len(), [NONE; 2]);
        let mut turned = 0;
        let mut at = 0;
        for f in 0..view.entry.faces.len() {
            let face = view.face(f);
            turned |= ((face.reversed != view.odd()) as u64) << f;
            let len = face.corners.len();
            let to = &mut self.corners[at..at + len];
            if face.reversed {
                // The edge behind a vertex is now the one that was before it.
                let mut before = face.corners[len - 1][1];
                for (to, &[v, e]) in to.iter_mut().rev().zip(face.corners) {
                    *to = [view.number(v).0, before as u32];
                    before = e;
                }
            } else {
                for (to, &[v, e]) in to.iter_mut().zip(face.corners) {
                    *to = [view.number(v).0, e as u32];
                }
            }
            let plane = match face.support {
                FaceSupport::Facet(c) => {
                    for c in face.corners {
                        self.edges[c[1] as usize].face = f as u32;
                    }
                    c as u32
                }
                FaceSupport::Function(g) => g.0 + FACETS,
                FaceSupport::Pair(..) => unreachable!("an interface's face"),
            };
            let cells = face.cells.map(|c| c.0);
            self.faces.push(Face { at: at as u32, len: len as u32, cells, plane, mark: 0, child: NONE, cut: NONE });
            at += len;
        }
        turned
    }

    fn enter_cells(&mut self, view: &View, turned: u64) {
        self.half_faces.extend(view.entry.half_faces.iter().map(|&h| h as u32 ^ (turned >> (h >> 1)) as u32 & 1));
        let mut at = 0;
        for cell in view.entry.cells {
            let len = cell.len as u32;
            self.cells.push(Cell { at, len, room: len, mark: 0 });
            at += len;
        }
    }
}
