//! The split of a convex polytope by a linear function, bottom-up: edges, faces, cell (section 4.1, Figure 5). Both complexes are made of
//! it: the arrangement keeps both parts, the interface keeps the negative one.
//!
//! An element is split if it has a positive and a negative vertex; zero is an ordinary sign. A face that is split is entered and left
//! once each, through an edge that is cut or at a vertex that is zero. The section of a cell is the loop of the new edges in
//! its faces and of those of its edges that are zero at both ends: each of the latter lies between a face without positive and one
//! without negative vertices, so it is taken from the former.
//!
//! Invariant: the loop of every face is strictly convex and runs counterclockwise when seen from its positive side. So, seen from
//! outside, the negative part of a cell has its boundary on the left of the new edges' way from where a face's boundary enters the
//! positive side to where it leaves it, and the section runs the other way.
//!
//! Cost: linear in the corners of the faces that are looked at. Each face is looked at once a round; nothing is allocated for one.

use super::work::{Class, Edge, FACETS, Face, NONE, State, Work};
use crate::base::few::copy_few;

/// What the signs around a face say.
struct LoopSigns {
    negative: bool,
    zero: bool,
    positive: bool,
    /// If crossed: the first corner of the positive run, and the first behind it.
    up: u32,
    down: u32,
    /// The corner before an edge that is zero at both ends.
    zero_edge: u32,
    /// Edges (by the corners before them) with a positive end and no negative one.
    dropped: u64,
}

/// In a face's mark: it has a vertex where the function vanishes.
const TOUCHED: u32 = 4;

impl Work {
    /// The class of a face; splits it if it is crossed. `KEEP`: whether positive parts are kept.
    #[inline(always)]
    pub fn class<const KEEP: bool>(&mut self, f: u32) -> Class {
        let mark = self.faces[f as usize].mark;
        let mark = if mark >> 3 == self.round { mark } else { self.new_class::<KEEP>(f) };
        match mark & 3 {
            0 => Class::Negative,
            1 => Class::Positive,
            2 => Class::Crossed,
            _ => Class::Zero,
        }
    }

    /// Whether the function vanishes somewhere on the boundary of a face that has been looked at.
    pub fn touched(&self, f: u32) -> bool {
        self.faces[f as usize].mark & TOUCHED != 0
    }

    fn new_class<const KEEP: bool>(&mut self, f: u32) -> u32 {
        let Face { at, len, .. } = self.faces[f as usize];
        let corners = at as usize..(at + len) as usize;
        if KEEP && !self.all_signs {
            for k in corners.clone() {
                self.sign(self.corners[k][0]);
            }
        }
        #[cfg(feature = "plain-signs")]
        self.refuse_ambiguous(f);
        let signs = if len <= 64 { self.few_signs::<KEEP>(corners.clone()) } else { self.many_signs(corners.clone()) };
        if !KEEP && signs.positive {
            self.drop_edges(corners, signs.dropped);
        }
        let class = match (signs.negative, signs.positive) {
            (true, false) => Class::Negative,
            (false, true) => Class::Positive,
            (true, true) => Class::Crossed,
            (false, false) => Class::Zero,
        };
        if class == Class::Crossed {
            self.cut_face::<KEEP>(f, signs.up as usize, signs.down as usize);
        } else {
            self.faces[f as usize].cut = signs.zero_edge;
        }
        let touched = if signs.zero { TOUCHED } else { 0 };
        let mark = self.round << 3 | touched | class as u32;
        self.faces[f as usize].mark = mark;
        mark
    }

    /// The signs around a loop of up to 64 corners, as bits.
    #[inline(always)]
    fn few_signs<const KEEP: bool>(&self, corners: std::ops::Range<usize>) -> LoopSigns {
        let (mut positive, mut zero) = (0u64, 0u64);
        let len = corners.len();
        for (k, corner) in self.corners[corners].iter().enumerate() {
            // 0, 1, 2: negative, zero, positive.
            let s = (self.vertices[corner[0] as usize].mark & 3) as u64;
            positive |= (s >> 1) << k;
            zero |= (s & 1) << k;
        }
        let all = u64::MAX >> (64 - len);
        let next = |bits: u64| (bits >> 1 | bits << (len - 1)) & all;
        let before = |bits: u64| (bits << 1 | bits >> (len - 1)) & all;
        let not_negative = positive | zero;
        let zero_edges = zero & next(zero);
        LoopSigns {
            negative: not_negative != all,
            zero: zero != 0,
            positive: positive != 0,
            up: (positive & !before(positive)).trailing_zeros(),
            down: (!positive & before(positive)).trailing_zeros(),
            zero_edge: if zero_edges != 0 { zero_edges.trailing_zeros() } else { NONE },
            dropped: if KEEP { 0 } else { not_negative & next(not_negative) & (positive | next(positive)) },
        }
    }

    /// The same for longer ones, without `dropped`.
    #[cold]
    #[inline(never)]
    fn many_signs(&self, corners: std::ops::Range<usize>) -> LoopSigns {
        let corners = &self.corners[corners];
        let sign = |corner: &[u32; 2]| self.vertices[corner[0] as usize].mark & 3;
        let mut signs =
            LoopSigns { negative: false, zero: false, positive: false, up: 0, down: 0, zero_edge: NONE, dropped: 0 };
        let mut before = corners.len() - 1;
        for (k, corner) in corners.iter().enumerate() {
            let (previous, s) = (sign(&corners[before]), sign(corner));
            match s {
                0 => signs.negative = true,
                1 => signs.zero = true,
                _ => signs.positive = true,
            }
            if (s == 2) != (previous == 2) {
                *(if s == 2 { &mut signs.up } else { &mut signs.down }) = k as u32;
            }
            if s == 1 && previous == 1 {
                signs.zero_edge = before as u32;
            }
            before = k;
        }
        signs
    }

    /// Drops the edges of a face that have a positive vertex and no negative one, once each.
    fn drop_edges(&mut self, corners: std::ops::Range<usize>, dropped: u64) {
        if corners.len() <= 64 {
            let mut rest = dropped;
            while rest != 0 {
                self.drop_edge(self.corners[corners.start + rest.trailing_zeros() as usize][1]);
                rest &= rest - 1;
            }
            return;
        }
        for k in corners.clone() {
            let [v, e] = self.corners[k];
            let to = self.corners[if k + 1 == corners.end { corners.start } else { k + 1 }][0];
            let (s, t) = (self.known_sign(v), self.known_sign(to));
            if s >= 0 && t >= 0 && s + t > 0 {
                self.drop_edge(e);
            }
        }
    }

    #[inline(always)]
    fn drop_edge(&mut self, e: u32) {
        let edge = &mut self.edges[e as usize];
        if edge.mark != self.round {
            edge.mark = self.round;
            self.dropped_edges.push(e);
        }
    }

    /// Cuts an edge with ends of unlike signs (once a round). Returns the new vertex and the parts next to `v` and
    /// beyond (the latter only if kept).
    #[inline]
    fn cut_edge<const KEEP: bool>(&mut self, e: u32, v: u32) -> (u32, u32, u32) {
        let edge = self.edges[e as usize];
        // The parts in order: `v`'s first.
        let parts = |cut: u32, child: u32| {
            let turned = edge.ends[0] != v;
            (cut, if turned { child } else { e }, if turned { e } else { child })
        };
        if edge.mark == self.round {
            return if KEEP { parts(edge.ends[1], edge.next) } else { (edge.next, e, NONE) };
        }
        let [a, b] = edge.ends;
        let plane = self.round - 1 + FACETS;
        let [p, q, r] = edge.planes;
        let planes = if KEEP { [p, q, plane, NONE] } else { [p, q, r, plane] };
        let (from, to) = (&self.vertices[a as usize], &self.vertices[b as usize]);
        let both = from.state == State::More && to.state == State::More;
        let cut = self.new_vertex(from.carrier | to.carrier, planes);
        if both {
            self.inherit(cut, a, b);
        }
        if KEEP {
            let child = self.edges.len() as u32;
            self.edges.push(Edge { ends: [cut, b], mark: self.round, ..edge });
            let e_mut = &mut self.edges[e as usize];
            e_mut.ends[1] = cut;
            e_mut.next = child;
            e_mut.mark = self.round;
            parts(cut, child)
        } else {
            let positive = (self.known_sign(b) > 0) as usize;
            let e_mut = &mut self.edges[e as usize];
            e_mut.ends[positive] = cut;
            e_mut.next = cut;
            e_mut.mark = self.round;
            self.set_vertex_edge(cut, e);
            (cut, e, NONE)
        }
    }

    /// Splits a face whose positive vertices are corners `up..down` (cyclic).
    fn cut_face<const KEEP: bool>(&mut self, f: u32, up: usize, down: usize) {
        let face = self.faces[f as usize];
        let (at, len) = (face.at as usize, face.len as usize);
        let before = if up == 0 { len - 1 } else { up - 1 };
        let last = if down == 0 { len - 1 } else { down - 1 };
        let [entry_vertex, entry_edge] = self.corners[at + before];
        let [_, exit_edge] = self.corners[at + last];
        let exit_vertex = self.corners[at + down][0];
        // Where the boundary enters and leaves the positive side, and the parts of the edges there.
        let entered_at_vertex = self.known_sign(entry_vertex) == 0;
        let left_at_vertex = self.known_sign(exit_vertex) == 0;
        let (p, entry_negative, entry_positive) = if entered_at_vertex {
            (entry_vertex, NONE, entry_edge)
        } else {
            self.cut_edge::<KEEP>(entry_edge, entry_vertex)
        };
        let (q, exit_negative, exit_positive) =
            if left_at_vertex { (exit_vertex, NONE, exit_edge) } else { self.cut_edge::<KEEP>(exit_edge, exit_vertex) };
        let plane = self.round - 1 + FACETS;
        let planes = if KEEP { [face.plane, plane, NONE] } else { [face.cells[1], face.cells[0], plane] };
        let cut = self.new_edge(Edge { ends: [p, q], planes, mark: 0, next: NONE, face: f });

        // Corners that each part keeps. A zero vertex where the boundary enters belongs to the negative part as the end of its last edge,
        // and where it leaves, as a corner like others.
        let round = |from: usize, to: usize| if from <= to { to - from } else { to + len - from };
        let positive = round(up, down);
        let negative = round(down, before) + !entered_at_vertex as usize;
        let start = self.corners.len();
        let negative_at = start + if KEEP { positive + 2 } else { 0 };
        let negative_len = negative + !left_at_vertex as usize + 1;
        // (Some at once: a call for a few bytes would cost more.)
        while self.corners.len() < negative_at + negative_len {
            self.corners.extend_from_slice(&[[NONE; 2]; 16]);
        }
        let (old, new) = self.corners.split_at_mut(start);
        let old = &mut old[at..at + len];
        let copy = |to: &mut [[u32; 2]], from: usize| {
            let mut k = from;
            for corner in to {
                *corner = old[k];
                k = if k + 1 == len { 0 } else { k + 1 };
            }
        };
        let mut child = NONE;
        if KEEP {
            let part = &mut new[..positive + 2];
            part[0] = [p, entry_positive];
            copy(&mut part[1..=positive], up);
            part[positive][1] = exit_positive;
            part[positive + 1] = [q, cut];
            child = self.faces.len() as u32;
            self.faces.push(Face { at: start as u32, len: positive as u32 + 2, mark: 0, ..face });
            // Edges on edges of the simplex know a face, which lies on a facet.
            if face.plane < FACETS {
                for &[_, e] in &*part {
                    // Chosen, not jumped to: it is as often so as not.
                    let e = &mut self.edges[e as usize];
                    e.face = if e.face == f { child } else { e.face };
                }
            }
        }
        let part = &mut new[negative_at - start..][..negative_len];
        let first = !left_at_vertex as usize;
        if !left_at_vertex {
            part[0] = [q, exit_negative];
        }
        copy(&mut part[first..first + negative], down);
        if !entered_at_vertex {
            part[first + negative - 1][1] = entry_negative;
        }
        part[first + negative] = [p, cut];
        let face = &mut self.faces[f as usize];
        face.at = if negative_len <= len {
            copy_few(&mut old[..negative_len], part);
            self.corners.truncate(negative_at);
            at as u32
        } else {
            self.corners.truncate(negative_at + negative_len);
            negative_at as u32
        };
        face.len = negative_len as u32;
        face.child = child;
        face.cut = cut;
    }

    /// Notes the part of a cell's section that one of its faces (as a half-face), negative or crossed, has.
    #[inline(always)]
    pub fn follow_section(&mut self, half: u32, crossed: bool) {
        let face = self.faces[(half >> 1) as usize];
        let (from, to, edge) = if crossed {
            // The negative part goes from the entry to the exit, the section back.
            let [p, q] = self.edges[face.cut as usize].ends;
            (q, p, face.cut)
        } else if face.cut != NONE {
            let [a, edge] = self.corners[(face.at + face.cut) as usize];
            let next = if face.cut + 1 == face.len { 0 } else { face.cut + 1 };
            (self.corners[(face.at + next) as usize][0], a, edge)
        } else {
            return;
        };
        // On the positive side of a face its boundary runs clockwise when seen from outside of the cell.
        let (from, to) = if half & 1 != 0 { (from, to) } else { (to, from) };
        self.follow[from as usize] = [edge, to];
        self.first = from;
    }

    /// The face that closes the section just noted, between two cells.
    pub fn close_section(&mut self, cells: [u32; 2], plane: u32) -> u32 {
        let at = self.corners.len() as u32;
        let first = self.first;
        let mut v = first;
        loop {
            let [edge, to] = self.follow[v as usize];
            self.corners.push([v, edge]);
            v = to;
            if v == first {
                break;
            }
            debug_assert!(self.corners.len() - (at as usize) <= self.vertices.len(), "a section that does not close");
            #[cfg(feature = "plain-signs")]
            self.refuse_endless(self.corners.len() - at as usize);
        }
        let len = self.corners.len() as u32 - at;
        debug_assert!(len >= 3);
        self.new_face(Face {
            at,
            len,
            cells,
            plane,
            mark: self.round << 3 | TOUCHED | Class::Zero as u32,
            child: NONE,
            cut: NONE,
        })
    }

    /// Sets a cell's half-faces, in place if there is room.
    pub fn set_cell(&mut self, c: u32, half_faces: &[u32]) {
        let cell = &mut self.cells[c as usize];
        let len = half_faces.len();
        if len <= cell.room as usize {
            copy_few(&mut self.half_faces[cell.at as usize..cell.at as usize + len], half_faces);
        } else {
            cell.at = self.half_faces.len() as u32;
            cell.room = len as u32;
            self.half_faces.extend_from_slice(half_faces);
        }
        cell.len = len as u32;
    }

    fn new_edge(&mut self, edge: Edge) -> u32 {
        if let Some(e) = self.free_edges.pop() {
            self.edges[e as usize] = edge;
            return e;
        }
        self.edges.push(edge);
        self.edges.len() as u32 - 1
    }

    fn new_face(&mut self, face: Face) -> u32 {
        if let Some(f) = self.free_faces.pop() {
            self.faces[f as usize] = face;
            return f;
        }
        self.faces.push(face);
        self.faces.len() as u32 - 1
    }

    fn set_vertex_edge(&mut self, v: u32, e: u32) {
        let v = v as usize;
        if self.vertex_edge.len() <= v {
            self.vertex_edge.resize(v + 1, NONE);
        }
        self.vertex_edge[v] = e;
    }
}
