//! Signs that are never wrong. STUB: signatures only, the bodies arrive with the kernel.
#![allow(unused)]
use std::cmp::Ordering;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(i8)]
pub enum Sign { Negative = -1, Zero = 0, Positive = 1 }
impl Sign {
    pub fn of(x: f64) -> Self { todo!() }
    pub fn is_zero(self) -> bool { self == Sign::Zero }
    pub fn to_i8(self) -> i8 { self as i8 }
}
impl std::ops::Neg for Sign { type Output = Sign; fn neg(self) -> Sign { todo!() } }
impl std::ops::Mul for Sign { type Output = Sign; fn mul(self, o: Sign) -> Sign { todo!() } }

/// An input plane: points x with n.x + d = 0; the positive side is where n.x + d > 0.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Plane { pub n: [f64; 3], pub d: f64 }

/// A plane as input or through a triangle; the triangle's positive side is where (b-a)x(c-a) points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Support { Plane(Plane), Triangle([[f64; 3]; 3]) }

/// A symbolic point. Lines and planes must meet in one point (the caller knows), else results are unspecified (no panic).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Point {
    Vertex([f64; 3]),
    EdgePlane { a: [f64; 3], b: [f64; 3], p: Plane },
    EdgeTriangle { a: [f64; 3], b: [f64; 3], t: [[f64; 3]; 3] },
    TrianglePlanes { t: [[f64; 3]; 3], p: Plane, q: Plane },
    Planes { p: Plane, q: Plane, r: Plane },
    /// Any three supports in general position: three triangles; two triangles and a plane; ...
    Supports([Support; 3]),
}

/// An exact direction (or normal): of a plane, of a triangle ((b-a)x(c-a)), or from a to b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction { Plane([f64; 3]), Triangle([[f64; 3]; 3]), Between([f64; 3], [f64; 3]) }

/// Coordinates with a bound: each true coordinate is within `err[i]` of `x[i]` (err may be infinite).
#[derive(Clone, Copy, Debug)]
pub struct Approx { pub x: [f64; 3], pub err: [f64; 3] }

/// n.v + d
pub fn side(p: &Plane, v: &[f64; 3]) -> Sign { todo!() }
/// Which side of a support a symbolic point is on.
pub fn support_side(s: &Support, x: &Point) -> Sign { todo!() }
/// p and q both properly cross segment ab: compares where, from a to b.
pub fn compare_on_edge(a: &[f64; 3], b: &[f64; 3], p: &Plane, q: &Plane) -> Ordering { todo!() }
/// Sign of the 3x3 determinant with rows p, q, r and columns their values n.x+d at the triangle's corners.
pub fn triangle_determinant(t: &[[f64; 3]; 3], p: &Plane, q: &Plane, r: &Plane) -> Sign { todo!() }
/// Orders two symbolic points by coordinate `axis`.
pub fn compare_coordinate(a: &Point, b: &Point, axis: usize) -> Ordering { todo!() }
/// Sign of det(u, v, w).
pub fn determinant(u: &Direction, v: &Direction, w: &Direction) -> Sign { todo!() }
/// Sign of (a x b) . (c x d)
pub fn cross_dot_cross(a: &Direction, b: &Direction, c: &Direction, d: &Direction) -> Sign { todo!() }
/// Sign of u . v
pub fn dot(u: &Direction, v: &Direction) -> Sign { todo!() }
/// Side of d relative to the plane through a, b, c: sign of det(b-a, c-a, d-a).
pub fn orient3d(a: &[f64; 3], b: &[f64; 3], c: &[f64; 3], d: &[f64; 3]) -> Sign { todo!() }
pub fn collinear(a: &[f64; 3], b: &[f64; 3], c: &[f64; 3]) -> bool { todo!() }
/// All three points' (u, v) = coordinates (ax, ay): sign of the turn a -> b -> c in that projection, symbolic points.
pub fn turn_projected(a: &Point, b: &Point, c: &Point, ax: usize, ay: usize) -> Sign { todo!() }
pub fn approx(x: &Point) -> Approx { todo!() }
/// Correctly rounded coordinates, ties to even, zero is +0.
pub fn round(x: &Point) -> [f64; 3] { todo!() }
pub fn rational(x: &Point) -> [rug::Rational; 3] { todo!() }
/// Correctly rounded double of a rational (rug's to_f64 truncates).
pub fn round_rational(x: &rug::Rational) -> f64 { todo!() }
