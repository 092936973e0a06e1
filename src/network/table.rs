//! What one linear function does to a simplex, by the signs at its corners, zeros included: a table made by the compiler. And the same for
//! a whole cube where no corner is zero.
//!
//! A *code* is the set of corners with positive values in the low half of a byte, negative ones in the high half. A point of the table is the
//! set of corners of its carrier, as a mask: one bit for a node, two for an edge.

use super::domain::{CUBE_TETS, PER_CUBE};

/// Ends of the edges of a tetrahedron; a triangle has those of corners 0, 1, 2 (numbers 0, 1 and 3).
pub const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The edge between the two corners of a mask.
pub const EDGE_OF_MASK: [u8; 16] = {
    let mut out = [u8::MAX; 16];
    let mut e = 0;
    while e < 6 {
        out[1 << EDGES[e][0] | 1 << EDGES[e][1]] = e as u8;
        e += 1;
    }
    out
};

/// Facet i, without corner i: counterclockwise seen from that corner, in a simplex of positive orientation. In two dimensions (first) the
/// corner is on the left of the way from the first to the second.
pub const FACETS: [[[usize; 3]; 4]; 2] = [
    [[1, 2, usize::MAX], [2, 0, usize::MAX], [0, 1, usize::MAX], [usize::MAX; 3]],
    [[2, 1, 3], [0, 2, 3], [1, 0, 3], [0, 1, 2]],
];

/// The polygon where a function vanishes.
#[derive(Clone, Copy)]
pub struct Loop {
    /// 0: the function has one sign and zeros only.
    pub len: u8,
    /// Counterclockwise seen from the positive side, in a simplex of positive orientation; in two dimensions with that side on the left.
    pub points: [u8; 4],
}

/// By dimension (2, 3) and code.
pub static LOOPS: [[Loop; 256]; 2] = [loops(2), loops(3)];

/// Corners of a simplex of positive orientation.
const PLACES: [[i32; 3]; 4] = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];

const fn loops(dim: usize) -> [Loop; 256] {
    let mut out = [Loop { len: 0, points: [0; 4] }; 256];
    let mut code = 0;
    while code < 256 {
        let (positive, negative) = (code & 15, code >> 4);
        if positive & negative == 0 && positive != 0 && negative != 0 && (positive | negative) >> (dim + 1) == 0 {
            out[code] = loop_of(dim, positive, negative);
        }
        code += 1;
    }
    out
}

const fn loop_of(dim: usize, positive: usize, negative: usize) -> Loop {
    let mut points = [0u8; 4];
    let mut len = 0;
    let mut p = 0;
    while p <= dim {
        if (positive | negative) >> p & 1 == 0 {
            points[len] = 1 << p;
            len += 1;
        } else if positive >> p & 1 == 1 {
            let mut q = 0;
            while q <= dim {
                if negative >> q & 1 == 1 {
                    points[len] = 1 << p | 1 << q;
                    len += 1;
                }
                q += 1;
            }
        }
        p += 1;
    }
    if len == 4 {
        // ac, ad, bc, bd: neighbours on the loop share a corner.
        (points[2], points[3]) = (points[3], points[2]);
    }
    let corner = PLACES[positive.trailing_zeros() as usize];
    let corner = [2 * corner[0], 2 * corner[1], 2 * corner[2]];
    let (a, b) = (twice(points[0]), twice(points[1]));
    let (u, w) = (minus(b, a), minus(corner, a));
    let turn = if dim == 2 {
        u[0] * w[1] - u[1] * w[0]
    } else {
        let v = minus(twice(points[2]), a);
        (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] + (u[0] * v[1] - u[1] * v[0]) * w[2]
    };
    assert!(turn != 0);
    if turn < 0 {
        let mut i = 0;
        while i < len / 2 {
            (points[i], points[len - 1 - i]) = (points[len - 1 - i], points[i]);
            i += 1;
        }
    }
    Loop { len: len as u8, points }
}

/// Twice the middle of a carrier.
const fn twice(mask: u8) -> [i32; 3] {
    let first = PLACES[mask.trailing_zeros() as usize];
    let last = PLACES[7 - mask.leading_zeros() as usize];
    [first[0] + last[0], first[1] + last[1], first[2] + last[2]]
}

const fn minus(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Edge slots of a node of a box: along x, y, z; the diagonals of the squares in xy, xz, yz whose lowest node it is.
pub const SLOTS: usize = 6;

/// An edge of a cube: the steps from the cube's lowest node to the node that has the edge, and its slot there.
#[derive(Clone, Copy)]
pub struct CubeEdge {
    pub steps: [usize; 3],
    pub slot: usize,
}

/// Twelve edges along the axes, then the diagonals.
pub const CUBE_EDGES: [CubeEdge; 18] = {
    let mut out = [CubeEdge { steps: [0; 3], slot: 0 }; 18];
    let mut axis = 0;
    while axis < 3 {
        let mut n = 0;
        while n < 4 {
            let (low, high) = (n & 1, n >> 1);
            out[4 * axis + n] = CubeEdge {
                steps: match axis {
                    0 => [0, low, high],
                    1 => [low, 0, high],
                    _ => [low, high, 0],
                },
                slot: axis,
            };
            n += 1;
        }
        let mut n = 0;
        while n < 2 {
            let mut steps = [0; 3];
            steps[axis] = n;
            // The square perpendicular to z is slot 3, to y 4, to x 5.
            out[12 + 2 * axis + n] = CubeEdge { steps, slot: 5 - axis };
            n += 1;
        }
        axis += 1;
    }
    out
};

/// The edge between two corners of a cube (those that are edges of its tetrahedra).
const fn cube_edge(a: usize, b: usize) -> u8 {
    let d = a ^ b;
    let low = a & b;
    if d.count_ones() == 1 {
        let axis = d.trailing_zeros() as usize;
        let n = match axis {
            0 => low >> 1,
            1 => low & 1 | low >> 2 << 1,
            _ => low & 3,
        };
        (4 * axis + n) as u8
    } else {
        let axis = (7 ^ d).trailing_zeros() as usize;
        (12 + 2 * axis + (low >> axis & 1)) as u8
    }
}

/// The edges of each tetrahedron of a cube, by the cube's parity.
pub static TET_EDGES: [[[u8; 6]; PER_CUBE]; 2] = {
    let mut out = [[[0; 6]; PER_CUBE]; 2];
    let mut parity = 0;
    while parity < 2 {
        let mut t = 0;
        while t < PER_CUBE {
            let mut e = 0;
            while e < 6 {
                out[parity][t][e] = cube_edge(CUBE_TETS[parity][t][EDGES[e][0]], CUBE_TETS[parity][t][EDGES[e][1]]);
                e += 1;
            }
            t += 1;
        }
        parity += 1;
    }
    out
};

/// A polygon in a tetrahedron of a cube.
#[derive(Clone, Copy)]
pub struct CubePolygon {
    pub tet: u8,
    pub len: u8,
    /// Edges of the cube.
    pub points: [u8; 4],
}

/// What a function without zeros does to a cube.
#[derive(Clone, Copy)]
pub struct CubeEntry {
    /// Edges that it crosses.
    pub edges: u32,
    pub len: u8,
    pub polygons: [CubePolygon; PER_CUBE],
}

/// By parity and the set of positive corners.
pub static CUBES: [[CubeEntry; 256]; 2] = [cubes(0), cubes(1)];

const fn cubes(parity: usize) -> [CubeEntry; 256] {
    let none = CubePolygon { tet: 0, len: 0, points: [0; 4] };
    let mut out = [CubeEntry { edges: 0, len: 0, polygons: [none; PER_CUBE] }; 256];
    let mut code = 0;
    while code < 256 {
        let entry = &mut out[code];
        let mut t = 0;
        while t < PER_CUBE {
            let corners = CUBE_TETS[parity][t];
            let mut positive = 0;
            let mut c = 0;
            while c < 4 {
                positive |= (code >> corners[c] & 1) << c;
                c += 1;
            }
            if positive != 0 && positive != 15 {
                let found = loop_of(3, positive, 15 ^ positive);
                let mut polygon = CubePolygon { tet: t as u8, len: found.len, points: [0; 4] };
                let mut i = 0;
                while i < found.len as usize {
                    let e = EDGES[EDGE_OF_MASK[found.points[i] as usize] as usize];
                    polygon.points[i] = cube_edge(corners[e[0]], corners[e[1]]);
                    entry.edges |= 1 << polygon.points[i];
                    i += 1;
                }
                entry.polygons[entry.len as usize] = polygon;
                entry.len += 1;
            }
            t += 1;
        }
        code += 1;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_81_codes_and_their_polygons_have_the_corners_that_they_must() {
        let mut codes = 0;
        for positive in 0..16usize {
            for negative in (0..16usize).filter(|n| n & positive == 0) {
                codes += 1;
                let l = LOOPS[1][positive | negative << 4];
                let zeros = 4 - (positive | negative).count_ones();
                let crossed = positive.count_ones() * negative.count_ones();
                let expected = if crossed == 0 { 0 } else { crossed + zeros };
                assert_eq!(l.len as u32, expected);
                let points = &l.points[..l.len as usize];
                for i in 0..points.len() {
                    assert!(!points[i + 1..].contains(&points[i]));
                    // Neighbours lie on a common facet.
                    let next = points[(i + 1) % points.len()];
                    assert!((points[i] | next).count_ones() <= 3);
                }
            }
        }
        assert_eq!(codes, 81);
    }

    #[test]
    fn edges_of_cubes_join_the_corners_of_their_slots() {
        for parity in 0..2 {
            for t in 0..PER_CUBE {
                for (e, ends) in EDGES.iter().enumerate() {
                    let edge = CUBE_EDGES[TET_EDGES[parity][t][e] as usize];
                    let at = edge.steps[0] + 2 * edge.steps[1] + 4 * edge.steps[2];
                    // The square or edge of the slot.
                    let span = [1, 2, 4, 3, 5, 6][edge.slot];
                    assert_eq!(at & span, 0);
                    for c in ends.map(|c| CUBE_TETS[parity][t][c]) {
                        assert_eq!(c & !span, at, "parity {parity}, tetrahedron {t}, edge {e}");
                    }
                }
            }
        }
    }
}
