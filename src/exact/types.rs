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
    /// Where functions that are linear on a simplex vanish.
    Zero(Zero),
}

/// A function that is linear on a simplex, by its values at the corners: first minus second, exactly. (`second` is zero for one that is given by itself.)
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Linear {
    pub first: [f64; 4],
    pub second: [f64; 4],
}

/// The point of an open simplex of `dim` dimensions where so many functions vanish: a corner, on an edge, in a triangle, in a tetrahedron. What
/// is behind `dim` is not read.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Zero {
    pub dim: u32,
    pub corners: [[f64; 3]; 4],
    pub functions: [Linear; 3],
}

/// How a linear function rises on a tetrahedron a, b, c, d with det(b − a, c − a, d − a) > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient {
    pub corners: [[f64; 3]; 4],
    pub function: Linear,
}

/// An exact direction (or normal): of a plane, of a triangle ((b-a)x(c-a)), from a to b, or of a gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    Plane([f64; 3]),
    Triangle([[f64; 3]; 3]),
    Between([f64; 3], [f64; 3]),
    Gradient(Gradient),
}

/// Coordinates with a bound: each true coordinate is within `err[i]` of `x[i]` (err may be infinite).
#[derive(Clone, Copy, Debug)]
pub struct Approx {
    pub x: [f64; 3],
    pub err: [f64; 3],
}
