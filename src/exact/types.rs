//! What predicates speak about: planes, supports, symbolic points, directions. All by value and all input: no
//! constructed coordinate is ever read.

/// An input plane: points x with n.x + d = 0; the positive side is where n.x + d > 0.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Plane {
    pub n: [f64; 3],
    pub d: f64,
}

/// A plane as input or through a triangle; the triangle's positive side is where (b-a)x(c-a) points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Support {
    Plane(Plane),
    Triangle([[f64; 3]; 3]),
}

/// A symbolic point. Lines and planes must meet in one point (the caller knows), else results are unspecified (no panic).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Point {
    Vertex([f64; 3]),
    EdgePlane {
        a: [f64; 3],
        b: [f64; 3],
        p: Plane,
    },
    EdgeTriangle {
        a: [f64; 3],
        b: [f64; 3],
        t: [[f64; 3]; 3],
    },
    /// Edges ab and cd of one plane, crossing. Seen along `axis` they cross, too.
    Edges {
        a: [f64; 3],
        b: [f64; 3],
        c: [f64; 3],
        d: [f64; 3],
        axis: usize,
    },
    TrianglePlanes {
        t: [[f64; 3]; 3],
        p: Plane,
        q: Plane,
    },
    Planes {
        p: Plane,
        q: Plane,
        r: Plane,
    },
    /// Any three supports in general position: three triangles; two triangles and a plane; ...
    Supports([Support; 3]),
}

/// An exact direction (or normal): of a plane, of a triangle ((b-a)x(c-a)), or from a to b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    Plane([f64; 3]),
    Triangle([[f64; 3]; 3]),
    Between([f64; 3], [f64; 3]),
}

/// Coordinates with a bound: each true coordinate is within `err[i]` of `x[i]` (err may be infinite).
#[derive(Clone, Copy, Debug)]
pub struct Approx {
    pub x: [f64; 3],
    pub err: [f64; 3],
}
