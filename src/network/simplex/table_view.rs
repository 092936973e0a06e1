//! A looked-up complex: read in place through its symmetry ([`View`]), or written out as a [`SimplexComplex`].
//!
//! Under a permutation of corners that is odd all loops run the other way round (in a simplex of positive orientation). What a face's
//! positive side is follows from the functions: the lowest one of an arrangement's face is positive there, the owner of an interface's
//! is the lower one; where a symmetry changes that, the sides are exchanged and the loop is turned round.
//!
//! Numbers: corners are vertices 0..=dim, cells of an interface are in the order of their owners; all other elements keep the numbers that
//! the entry gives them, which are not those of the incremental construction. Cost of a view: nothing; of writing out: linear, without searches or arithmetic on values.

use super::data::*;
use super::tables::{ENTRIES, Entry, EntryFace, Found, PERMUTATIONS, SYMMETRIES};

/// Where each set of corners goes, by permutation.
static CORNER_SETS: [[u8; 16]; 24] = {
    let mut out = [[0; 16]; 24];
    let mut i = 0;
    while i < 24 * 16 {
        out[i / 16][i % 16] = image(&PERMUTATIONS[i / 16], i % 16);
        i += 1;
    }
    out
};

/// Where each set of functions goes, by symmetry.
static FUNCTION_SETS: [[u8; 8]; 14] = {
    let mut out = [[0; 8]; 14];
    let mut i = 0;
    while i < 14 * 8 {
        out[i / 8][i % 8] = image(&SYMMETRIES[i / 8].to, i % 8);
        i += 1;
    }
    out
};

const fn image(to: &[u8], set: usize) -> u8 {
    let (mut out, mut k) = (0, 0);
    while k < to.len() {
        out |= ((set >> k & 1) as u8) << to[k];
        k += 1;
    }
    out
}

/// No entry has more vertices.
const MOST: usize = 32;

/// The number of each of an entry's vertices, by permutation: only corners have others.
static NUMBERS: [[u8; MOST]; 24] = {
    let mut out = [[0; MOST]; 24];
    let mut i = 0;
    while i < 24 * MOST {
        let (p, v) = (i / MOST, i % MOST);
        out[p][v] = if v < 4 { PERMUTATIONS[p][v] } else { v as u8 };
        i += 1;
    }
    let mut e = 0;
    while e < ENTRIES.len() {
        assert!(ENTRIES[e].vertices.len() <= MOST);
        e += 1;
    }
    out
};

/// The entry's corner for each of the simplex's; and whether the permutation is odd.
static INVERSE: [([u8; 4], bool); 24] = {
    let mut out = [([0; 4], false); 24];
    let mut i = 0;
    while i < 24 {
        let p = PERMUTATIONS[i];
        let mut c = 0;
        while c < 4 {
            out[i].0[p[c] as usize] = c as u8;
            let mut d = 0;
            while d < c {
                out[i].1 ^= p[d] > p[c];
                d += 1;
            }
            c += 1;
        }
        i += 1;
    }
    out
};

/// The members of a set, rising; the rest is `NONE`.
const LISTS: [[LocalFunction; 4]; 8] = {
    let mut out = [[LocalFunction(u32::MAX); 4]; 8];
    let mut set = 0;
    while set < 8 {
        let (mut n, mut k) = (0, 0);
        while k < 3 {
            if set >> k & 1 == 1 {
                out[set][n] = LocalFunction(k as u32);
                n += 1;
            }
            k += 1;
        }
        set += 1;
    }
    out
};

#[inline(always)]
fn list(set: u8) -> &'static [LocalFunction] {
    &LISTS[set as usize & 7][..(set & 7).count_ones() as usize]
}

#[inline(always)]
fn lowest(set: u8) -> LocalFunction {
    LocalFunction(set.trailing_zeros())
}

/// A complex as it lies in the table. Sets of functions are masks.
#[derive(Clone, Copy)]
pub struct View {
    pub entry: &'static Entry,
    permutation: &'static [u8; 4],
    numbers: &'static [u8; MOST],
    inverse: &'static [u8; 4],
    corner_sets: &'static [u8; 16],
    function_sets: &'static [u8; 8],
    /// The entry's functions that change their signs.
    flip: u8,
    odd: bool,
    /// MI: all owners.
    owners: u8,
}

/// A face of a [`View`].
#[derive(Clone, Copy, Debug)]
pub struct ViewFace {
    pub support: FaceSupport,
    /// All functions that vanish (materials that are largest) on it.
    pub functions: u8,
    /// IA: those that are negative on the positive side.
    pub opposite: u8,
    /// On the positive and the negative side; `NONE` outside of the simplex.
    pub cells: [LocalCell; 2],
    /// Vertices (by the entry's numbers, see [`View::vertex`]) and the edges from there to the next, as the entry has them.
    pub corners: &'static [[u8; 2]],
    /// The loop runs the other way round.
    pub reversed: bool,
}

impl ViewFace {
    /// The loop, counterclockwise when seen from the positive side (in a simplex of positive orientation), by the entry's numbers.
    #[inline(always)]
    pub fn vertices(&self) -> impl Iterator<Item = u8> + use<> {
        let (corners, reversed) = (self.corners, self.reversed);
        let last = corners.len() - 1;
        (0..corners.len()).map(move |k| corners[if reversed { last - k } else { k }][0])
    }
}

impl View {
    #[inline(always)]
    pub fn new(found: Found) -> Self {
        let (p, s) = (found.corners as usize, found.functions as usize);
        let (inverse, odd) = &INVERSE[p];
        let entry = &ENTRIES[found.entry as usize];
        let mut owners = 0;
        if entry.table.kind == Kind::Interface {
            for cell in entry.cells {
                let label = FUNCTION_SETS[s][cell.label as usize & 7];
                owners |= label & label.wrapping_neg();
            }
        }
        Self {
            entry,
            permutation: &PERMUTATIONS[p],
            numbers: &NUMBERS[p],
            inverse,
            corner_sets: &CORNER_SETS[p],
            function_sets: &FUNCTION_SETS[s],
            flip: SYMMETRIES[s].flip,
            odd: *odd,
            owners,
        }
    }

    /// Whether loops run the other way round (but for faces whose sides are exchanged).
    #[inline(always)]
    pub fn odd(&self) -> bool {
        self.odd
    }

    #[inline(always)]
    fn functions(&self, set: u8) -> u8 {
        self.function_sets[set as usize & 7]
    }

    /// The number in the simplex for a vertex of the entry: only corners have others.
    #[inline(always)]
    pub fn number(&self, v: u8) -> LocalVertex {
        LocalVertex(self.numbers[v as usize & (MOST - 1)] as u32)
    }
    /// A vertex, by the entry's number: its carrier, and the functions that vanish (materials that are largest) there.
    #[inline(always)]
    pub fn vertex(&self, v: u8) -> (Carrier, u8) {
        let vertex = &self.entry.vertices[v as usize];
        (Carrier(self.corner_sets[vertex.carrier as usize & 15]), self.functions(vertex.functions))
    }
    /// The smallest sub-simplex that holds both of two vertices, and the functions that vanish at both.
    #[inline(always)]
    pub fn between(&self, [u, v]: [u8; 2]) -> (Carrier, u8) {
        let (u, v) = (&self.entry.vertices[u as usize], &self.entry.vertices[v as usize]);
        let carrier = self.corner_sets[(u.carrier | v.carrier) as usize & 15];
        (Carrier(carrier), self.functions(u.functions & v.functions))
    }
    /// Its encoding, as a set.
    #[inline(always)]
    pub fn encoding(&self, v: u8) -> u8 {
        self.functions(self.entry.vertices[v as usize].encoding)
    }
    /// The number in the simplex for a cell of the entry.
    #[inline(always)]
    fn cell(&self, c: u8) -> LocalCell {
        if c == u8::MAX || self.entry.table.kind == Kind::Arrangement {
            return if c == u8::MAX { LocalCell::NONE } else { LocalCell(c as u32) };
        }
        let owner = lowest(self.functions(self.entry.cells[c as usize].label));
        LocalCell((self.owners & ((1 << owner.0) - 1)).count_ones())
    }
    /// IA: functions that are positive in a cell. MI: materials that are largest, of which the lowest owns it.
    #[inline(always)]
    pub fn label(&self, cell: LocalCell) -> u8 {
        if self.entry.table.kind == Kind::Arrangement {
            let crossed = ((1u8 << self.entry.table.functions) - 1) & !self.entry.zero;
            return self.functions((self.entry.cells[cell.at()].label ^ self.flip) & crossed);
        }
        self.functions(self.entry.cells[self.entry_cell(cell)].label)
    }
    /// The entry's number for a cell: at most three owners.
    #[inline(always)]
    fn entry_cell(&self, cell: LocalCell) -> usize {
        match self.entry.table.kind {
            Kind::Arrangement => cell.at(),
            Kind::Interface => (0..self.entry.cells.len() - 1)
                .find(|&c| self.cell(c as u8) == cell)
                .unwrap_or(self.entry.cells.len() - 1),
        }
    }
    /// IA: functions that vanish everywhere.
    #[inline(always)]
    pub fn zero(&self) -> u8 {
        self.functions(self.entry.zero)
    }

    /// A face, by its number.
    #[inline(always)]
    pub fn face(&self, f: usize) -> ViewFace {
        let face = &self.entry.faces[f];
        let EntryFace { start, len, facet, functions, opposite, cells } = *face;
        let set = self.functions(functions);
        let mut opposite = self.functions((opposite ^ self.flip) & functions);
        let mut cells = cells.map(|c| self.cell(c));
        let mut turned = false;
        let support = if facet != EntryFace::INSIDE {
            FaceSupport::Facet(self.permutation[facet as usize & 3])
        } else if self.entry.table.kind == Kind::Arrangement {
            let first = lowest(set);
            turned = opposite >> first.0 & 1 == 1;
            if turned {
                opposite ^= set;
            }
            FaceSupport::Function(first)
        } else {
            // Cells are in the order of their owners.
            turned = cells[0] > cells[1];
            let [a, b] = face.cells.map(|c| lowest(self.functions(self.entry.cells[c as usize].label)));
            if turned { FaceSupport::Pair(b, a) } else { FaceSupport::Pair(a, b) }
        };
        if turned {
            cells.swap(0, 1);
        }
        let corners = &self.entry.corners[start as usize..start as usize + len as usize];
        if self.entry.table.kind == Kind::Interface {
            opposite = 0;
        }
        ViewFace { support, functions: set, opposite, cells, corners, reversed: self.odd != turned }
    }

    /// Writes the complex out.
    pub fn fill(&self, out: &mut SimplexComplex) {
        let entry = self.entry;
        let (kind, dim, n) = (entry.table.kind, entry.table.dim, entry.table.functions);
        out.clear(kind, dim, n);
        let count = entry.vertices.len();
        for i in 0..count {
            let v = if i <= dim { self.inverse[i & 3] } else { i as u8 };
            let (carrier, functions) = self.vertex(v);
            out.vertex_carrier.push(carrier);
            out.vertex_encoding.push(LISTS[self.encoding(v) as usize]);
            out.vertex_functions.push_row(list(functions));
        }
        out.edges.extend(entry.edges.iter().map(|e| e.map(|v| self.number(v))));

        let arrangement = kind == Kind::Arrangement;
        // Rows of planes: an arrangement's facets, then the planes of functions in the order of the lowest; an interface's faces.
        let mut rows = [(0u8, 0u8); 6];
        let inside = entry.faces.iter().filter(|f| f.facet == EntryFace::INSIDE).map(|f| self.functions(f.functions));
        let lowest_ones = inside.fold(0u8, |all, set| all | set & set.wrapping_neg());
        // Faces whose sides are exchanged.
        let mut turned = 0u64;
        for f in 0..entry.faces.len() {
            let face = self.face(f);
            let side = face.reversed != self.odd;
            turned |= (side as u64) << f;
            out.face_support.push(face.support);
            out.face_cells.push(face.cells);
            let row = match face.support {
                FaceSupport::Facet(i) => i as u32,
                FaceSupport::Function(g) => dim as u32 + 1 + (lowest_ones & ((1 << g.0) - 1)).count_ones(),
                FaceSupport::Pair(..) => 0,
            };
            if arrangement {
                rows[row as usize] = (face.functions, face.opposite);
                out.face_plane.push(LocalPlane(row));
            } else {
                out.face_plane.push(LocalPlane(f as u32));
                out.plane_functions.push_row(list(face.functions));
            }
            let corners = face.corners;
            let loop_vertices = &mut out.face_vertices.items;
            if face.reversed {
                loop_vertices.extend(corners.iter().rev().map(|c| self.number(c[0])));
            } else {
                loop_vertices.extend(corners.iter().map(|c| self.number(c[0])));
            }
            out.face_vertices.end_row();
            if dim == 3 {
                let edge = |c: &[u8; 2]| LocalEdge(c[1] as u32);
                if face.reversed {
                    // The edge behind a vertex is now the one that was before it.
                    let last = corners.len() - 1;
                    out.face_edges.extend(corners[..last].iter().rev().map(edge));
                    out.face_edges.push(edge(&corners[last]));
                } else {
                    out.face_edges.extend(corners.iter().map(edge));
                }
            }
        }
        let mut starts = [0; 5];
        for (c, cell) in entry.cells.iter().enumerate() {
            starts[c + 1] = starts[c] + cell.len as usize;
        }
        for k in 0..entry.cells.len() {
            let c = self.entry_cell(LocalCell::of(k));
            let half_faces = &entry.half_faces[starts[c]..starts[c + 1]];
            let turn = |&h: &u8| LocalHalfFace(h as u32 ^ (turned >> (h >> 1)) as u32 & 1);
            out.cell_faces.items.extend(half_faces.iter().map(turn));
            out.cell_faces.end_row();
            let label = self.label(LocalCell::of(k));
            if arrangement {
                out.cell_positive.push(label as u64);
            } else {
                out.cell_owner.push(lowest(label));
                out.cell_materials.push_row(list(label));
            }
        }
        if arrangement {
            for &(set, opposite) in &rows[..dim + 1 + lowest_ones.count_ones() as usize] {
                out.plane_functions.push_row(list(set));
                out.plane_opposite.extend(list(set).iter().map(|f| opposite >> f.0 & 1 == 1));
            }
            out.zero_functions.push(self.zero() as u64);
        }
    }
}
