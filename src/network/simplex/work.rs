//! The complex while it grows: arenas of small records, what they begin with, vertices and the sets of functions that vanish there.
//!
//! A *plane* is a number: 0..4 are the simplex's facets (facet c lies opposite to corner c, x_c = 0), 4 + k is function k. In an interface
//! the same numbers are the hyperplanes of the polyhedron above the envelope (see [`super::interface`]): the walls over the facets and
//! the graphs of the materials. A triangle is worked as the tetrahedron over it whose fourth corner, the *apex*, has value zero
//! in every function: all its elements are cones over those of the triangle, which are read off the facet opposite to the apex.

pub(super) const NONE: u32 = u32::MAX;
/// Planes below are facets.
pub(super) const FACETS: u32 = 4;

/// 64 bytes, a cache line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    /// Barycentric coordinates, up to a positive factor; NaN where rounding leaves nothing certain.
    pub x: [f64; 4],
    /// Interface: the value of the envelope, scaled like `x`. Arrangement: 0.
    pub w: f64,
    /// Independent planes that meet in this point alone, rising: three (interface: four hyperplanes), padded with [`NONE`].
    pub planes: [u32; 4],
    /// The sign of the current function here: round << 2 | sign + 1. Stale if the round is another.
    pub mark: u32,
    pub carrier: u8,
    /// Corners of the carrier (0 for the summit).
    pub size: u8,
    /// Orientation of the functions among `planes`: 2 if not yet known.
    pub orientation: i8,
    pub state: State,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum State {
    /// No other functions than those of its planes vanish (are largest) here.
    Plain,
    /// Some others do; see `more`.
    More,
    /// To be used again.
    Dead,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub ends: [u32; 2],
    /// Two independent planes that hold it, rising (interface: three hyperplanes).
    pub planes: [u32; 3],
    /// The round in which it was cut (or dropped).
    pub mark: u32,
    /// Arrangement: the edge that goes on behind `ends[1]` on the same edge of the simplex; right after a cut, the other
    /// part. Interface: the vertex of the last cut.
    pub next: u32,
    /// A face that has it. Arrangement: kept for edges on edges of the simplex only.
    pub face: u32,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Corners `at..at + len`.
    pub at: u32,
    pub len: u32,
    /// On the positive and the negative side.
    pub cells: [u32; 2],
    /// Arrangement: what it lies on. (Interface: its cells say that.)
    pub plane: u32,
    /// round << 3 | touched << 2 | class
    pub mark: u32,
    /// Right after a cut: the positive part.
    pub child: u32,
    /// The edge along which it was cut, from where its boundary enters the positive side to where it leaves it; if not cut, the
    /// corner before an edge on which the function vanishes.
    pub cut: u32,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cell {
    /// Half-faces `at..at + len`, room for `room`.
    pub at: u32,
    pub len: u32,
    pub room: u32,
    pub mark: u32,
}

/// Where the current function's signs put a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Class {
    Negative,
    Positive,
    Crossed,
    Zero,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Work {
    pub interface: bool,
    /// Values as given, four a function (the apex has 0).
    pub values: Vec<[f64; 4]>,
    /// The same scaled, for dot products: every function by a power of two of its own to maximum 1/2..1; in an interface all by
    /// one, as differences to the highest of all at each corner.
    pub scaled: Vec<[f64; 4]>,
    /// Interface: all values scaled by one power of two.
    pub raised: Vec<[f64; 4]>,

    pub vertices: Vec<Vertex>,
    /// Functions that vanish at a vertex beyond its planes, as lists in `more`.
    pub more_head: Vec<u32>,
    pub more: Vec<[u32; 2]>,
    /// While a section is gathered: the edge and the vertex that follow each vertex.
    pub follow: Vec<[u32; 2]>,
    /// Interface: an edge of each vertex.
    pub vertex_edge: Vec<u32>,
    pub edges: Vec<Edge>,
    /// Arrangement: of each edge of the simplex, the part at its first corner (the others follow by `next`).
    pub first_part: [u32; 6],
    pub faces: Vec<Face>,
    /// Corners of faces: a vertex and the edge from there to the next.
    pub corners: Vec<[u32; 2]>,
    pub cells: Vec<Cell>,
    /// Half-faces of cells: face << 1 | side.
    pub half_faces: Vec<u32>,

    /// The round: function k is entered in round k + 1.
    pub round: u32,
    /// Arrangement: all vertices have this round's signs. (In an interface they always do.)
    pub all_signs: bool,
    /// Existing vertices at which the current function vanishes.
    pub zeros: Vec<u32>,
    pub stack: Vec<u32>,
    pub kept: Vec<u32>,
    pub moved: Vec<u32>,
    /// Per plane, for intersections of sets.
    pub tick: u32,
    pub ticks: Vec<u32>,
    /// Interface: numbers to use again, and those to be so after the round.
    pub free_vertices: Vec<u32>,
    pub free_edges: Vec<u32>,
    pub free_faces: Vec<u32>,
    pub dropped: Vec<u32>,
    pub dropped_edges: Vec<u32>,
    pub dropped_faces: Vec<u32>,

    /// Arrangement: planes of functions, see `arrangement`.
    pub function_plane: Vec<u32>,
    pub function_opposite: Vec<bool>,
    /// Interface: the next material that is equal to this one everywhere.
    pub twin: Vec<u32>,
    /// A vertex of the section being gathered.
    pub first: u32,
    /// Signs that the bound has decided.
    pub filtered: u64,
    /// See [`super::plain`].
    #[cfg(feature = "plain-signs")]
    pub plain: bool,
}

/// Ends of the simplex's edges.
pub(super) const EDGE_CORNERS: [[u32; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
/// The vertex above all others in an interface.
pub(super) const SUMMIT: u32 = 4;

/// What a work begins with. First the simplex: edges as in [`EDGE_CORNERS`], face c opposite to corner c, counterclockwise when seen from
/// inside (in a simplex of positive orientation). Then what an interface adds: edges 6 + c from corner c to the summit, and
/// face 4 + e over edge e between the two walls that share it, the higher one on its positive side.
const CORNERS: [[[u32; 2]; 3]; 10] = [
    [[1, 4], [3, 5], [2, 3]],
    [[0, 1], [2, 5], [3, 2]],
    [[0, 2], [3, 4], [1, 0]],
    [[0, 0], [1, 3], [2, 1]],
    [[0, 0], [1, 7], [4, 6]],
    [[2, 1], [0, 6], [4, 8]],
    [[0, 2], [3, 9], [4, 6]],
    [[1, 3], [2, 8], [4, 7]],
    [[3, 4], [1, 7], [4, 9]],
    [[2, 5], [3, 9], [4, 8]],
];
/// Half-faces of the walls and of the first material's cell.
const WALLS: [[u32; 4]; 5] = [[1, 15, 17, 19], [3, 11, 13, 18], [5, 9, 12, 16], [7, 8, 10, 14], [0, 2, 4, 6]];

const START: Start = Start {
    vertices: {
        let mut all = [Vertex::at_corner(0); 5];
        let mut c = 0;
        while c < 4 {
            all[c] = Vertex::at_corner(c);
            c += 1;
        }
        // The summit is above everything.
        all[4].x = [0.0; 4];
        all[4].w = 1.0;
        all[4].planes = [0, 1, 2, 3];
        (all[4].carrier, all[4].size) = (0, 0);
        all
    },
    edges: {
        let mut all = [Edge { ends: [0; 2], planes: [NONE; 3], mark: 0, next: NONE, face: 4 }; 10];
        let mut e = 0;
        while e < 6 {
            // An edge lies on the two facets opposite to the ends of its opposite edge.
            let [p, q] = EDGE_CORNERS[5 - e];
            (all[e].ends, all[e].planes, all[e].face) = (EDGE_CORNERS[e], [p, q, NONE], p);
            e += 1;
        }
        let mut c = 0;
        while c < 4 {
            let [p, q, r, _] = Vertex::at_corner(c).planes;
            (all[6 + c].ends, all[6 + c].planes) = ([c as u32, SUMMIT], [p, q, r]);
            c += 1;
        }
        // Face 4 knows corners 0 and 1.
        (all[8].face, all[9].face) = (5, 6);
        all
    },
    faces: {
        let mut all = [Face { at: 0, len: 3, cells: [0, NONE], plane: NONE, mark: 0, child: NONE, cut: NONE }; 10];
        let mut f = 0;
        while f < 10 {
            all[f].at = 3 * f as u32;
            if f < 4 {
                all[f].plane = f as u32;
            } else {
                let [p, q] = EDGE_CORNERS[9 - f];
                all[f].cells = [q, p];
            }
            f += 1;
        }
        all
    },
};

struct Start {
    vertices: [Vertex; 5],
    edges: [Edge; 10],
    faces: [Face; 10],
}

impl Vertex {
    /// The functions among its planes, from the front: facets come before them, as many as its carrier lacks corners.
    #[inline(always)]
    pub fn functions(&self) -> [u32; 4] {
        let p = self.planes.map(|p| if p == NONE { NONE } else { p.wrapping_sub(FACETS) });
        let p = [p[0], p[1], p[2], p[3], NONE, NONE, NONE, NONE];
        let facets = (4 - self.size as usize) & 3;
        std::array::from_fn(|k| p[facets + k])
    }

    /// Corner c, without a function.
    const fn at_corner(c: usize) -> Self {
        let mut x = [0.0; 4];
        x[c] = 1.0;
        let planes = [[1, 2, 3, NONE], [0, 2, 3, NONE], [0, 1, 3, NONE], [0, 1, 2, NONE]][c];
        Self { x, w: 0.0, planes, mark: 0, carrier: 1 << c, size: 1, orientation: 2, state: State::Plain }
    }
}

impl Work {
    /// Takes the values and starts with the simplex's corners alone; [`Work::start_simplex`] or [`Work::enter_first_two`] comes next.
    pub fn start(&mut self, dim: usize, values: &[f64], interface: bool) {
        self.interface = interface;
        self.values.clear();
        if dim == 3 {
            self.values.extend(values.as_chunks::<4>().0);
        } else {
            self.values.extend(values.as_chunks::<3>().0.iter().map(|&[a, b, c]| [a, b, c, 0.0]));
        }
        debug_assert!(values.iter().all(|x| x.is_finite()));
        if interface {
            self.scale_together()
        } else {
            self.scale_each()
        }

        let n = self.values.len();
        self.round = 0;
        self.tick = 0;
        self.ticks.clear();
        self.ticks.resize(n + FACETS as usize, 0);
        self.vertices.clear();
        self.more_head.clear();
        self.more.clear();
        self.follow.clear();
        self.edges.clear();
        self.faces.clear();
        self.corners.clear();
        self.cells.clear();
        self.half_faces.clear();
        self.free_vertices.clear();
        self.free_edges.clear();
        self.free_faces.clear();
        self.vertices.extend_from_slice(&START.vertices[..4]);
        self.more_head.extend_from_slice(&[NONE; 4]);
        self.follow.extend_from_slice(&[[NONE; 2]; 4]);
    }

    /// The simplex alone.
    pub fn start_simplex(&mut self) {
        if self.interface {
            for (c, v) in self.vertices.iter_mut().enumerate() {
                v.planes[3] = FACETS;
                v.w = self.scaled[0][c];
            }
            self.vertices.push(START.vertices[SUMMIT as usize]);
            self.more_head.push(NONE);
            self.follow.push([NONE; 2]);
            self.edges.extend_from_slice(&START.edges);
            self.edges[..6].iter_mut().for_each(|e| e.planes[2] = FACETS);
            self.faces.extend_from_slice(&START.faces);
            self.faces[..4].iter_mut().enumerate().for_each(|(f, face)| face.cells = [FACETS, f as u32]);
            self.corners.extend_from_slice(CORNERS.as_flattened());
            self.half_faces.extend_from_slice(WALLS.as_flattened());
            // Cells are numbered by their hyperplanes.
            self.cells.extend((0..5).map(|c| Cell { at: 4 * c, len: 4, room: 4, mark: 0 }));
            self.cells.resize(self.values.len() + FACETS as usize, Cell::default());
            self.vertex_edge.clear();
            self.vertex_edge.extend([6, 7, 8, 9, 6]);
        } else {
            self.edges.extend_from_slice(&START.edges[..6]);
            self.first_part = [0, 1, 2, 3, 4, 5];
            self.faces.extend_from_slice(&START.faces[..4]);
            self.corners.extend_from_slice(CORNERS[..4].as_flattened());
            self.push_cell(&[0, 2, 4, 6]);
        }
    }

    pub fn push_cell(&mut self, half_faces: &[u32]) {
        let (at, len) = (self.half_faces.len() as u32, half_faces.len() as u32);
        self.half_faces.extend_from_slice(half_faces);
        self.cells.push(Cell { at, len, room: len, mark: 0 });
    }

    /// A vertex where these planes meet on a carrier; the current function vanishes there. Returns its number.
    pub fn new_vertex(&mut self, carrier: u8, planes: [u32; 4]) -> u32 {
        const SIZES: [u8; 16] = [0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4];
        let mut vertex = Vertex {
            x: [0.0; 4],
            w: 0.0,
            planes,
            mark: self.round << 2 | 1,
            carrier,
            size: SIZES[carrier as usize & 15],
            orientation: 2,
            state: State::Plain,
        };
        let ids = vertex.functions();
        if self.interface {
            (vertex.x, vertex.w) = self.meet_interface(carrier, vertex.size, &ids);
        } else {
            vertex.x = self.meet(carrier, vertex.size, &ids);
        }
        if let Some(v) = self.free_vertices.pop() {
            self.vertices[v as usize] = vertex;
            self.more_head[v as usize] = NONE;
            return v;
        }
        self.vertices.push(vertex);
        self.more_head.push(NONE);
        self.follow.push([NONE; 2]);
        self.vertices.len() as u32 - 1
    }

    /// Adds the current function to the sets of the existing vertices where it vanishes. The apex is no vertex of the triangle.
    pub fn record_zeros(&mut self, dim: usize) {
        let plane = self.round - 1 + FACETS;
        for i in 0..self.zeros.len() {
            let v = self.zeros[i] as usize;
            if dim == 2 && self.vertices[v].carrier == 0b1000 {
                continue;
            }
            self.more.push([plane, self.more_head[v]]);
            self.more_head[v] = self.more.len() as u32 - 1;
            self.vertices[v].state = State::More;
        }
    }

    /// What `v`, just made inside the edge (a, b), lies on beyond its planes: what holds the whole edge, that is both of its ends. If
    /// one of them has no more than its planes, then only one of those does not hold the edge, and nothing is left.
    #[cold]
    #[inline(never)]
    pub fn inherit(&mut self, v: u32, a: u32, b: u32) {
        self.tick += 1;
        self.tick_all(a, self.tick);
        self.tick += 1;
        // From a's set those in b's, then without v's own planes.
        let (from, to) = (self.tick - 1, self.tick);
        let b_planes = self.vertices[b as usize].planes;
        for p in b_planes {
            if p != NONE && self.ticks[p as usize] == from {
                self.ticks[p as usize] = to;
            }
        }
        let mut i = self.more_head[b as usize];
        while i != NONE {
            let [p, next] = self.more[i as usize];
            if self.ticks[p as usize] == from {
                self.ticks[p as usize] = to;
            }
            i = next;
        }
        for p in self.vertices[v as usize].planes {
            if p != NONE {
                self.ticks[p as usize] = 0;
            }
        }
        // The members of a's set come once each, so each left is added once.
        let add = |work: &mut Self, p: u32| {
            if p >= FACETS && p != NONE && work.ticks[p as usize] == to {
                work.ticks[p as usize] = 0;
                work.more.push([p, work.more_head[v as usize]]);
                work.more_head[v as usize] = work.more.len() as u32 - 1;
                work.vertices[v as usize].state = State::More;
            }
        };
        for p in self.vertices[a as usize].planes {
            add(self, p);
        }
        let mut i = self.more_head[a as usize];
        while i != NONE {
            let [p, next] = self.more[i as usize];
            add(self, p);
            i = next;
        }
    }

    fn tick_all(&mut self, v: u32, tick: u32) {
        for p in self.vertices[v as usize].planes {
            if p != NONE {
                self.ticks[p as usize] = tick;
            }
        }
        let mut i = self.more_head[v as usize];
        while i != NONE {
            let [p, next] = self.more[i as usize];
            self.ticks[p as usize] = tick;
            i = next;
        }
    }
}
