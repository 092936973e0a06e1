//! Signs that are never wrong: filters, bounds, integers on the stack, integers of any size; symbolic points;
//! correct rounding; families of planes; counters.
//!
//! Every predicate equals what exact rational arithmetic gives, for any finite input. Read [`ring`] first (one
//! formula, many number types), then [`tiers`] and [`predicates`].

pub mod barycentric;
pub mod big;
pub mod bounded;
pub mod counters;
pub mod cyclic;
pub mod double_double;
pub mod filter;
pub mod fixed;
pub mod in_simplex;
mod interpolate;
pub mod lift;
pub mod planes;
pub mod points;
pub mod predicates;
pub mod residue;
pub mod ring;
pub mod round;
pub mod rows;
pub mod sign;
pub mod static_filters;
pub mod tiers;
pub mod types;

pub use cyclic::sort_cyclic;
pub use filter::PlaneFilter;
pub use in_simplex::{InTetrahedron, InTriangle, OnEdge, compare_zeros};
pub use planes::{Grouping, group};
pub use predicates::{
    collinear, compare_coordinate, compare_on_edge, compare_projected, compare_rounded, cross_dot_cross, determinant,
    dot, orient3d, side, support_side, triangle_determinant, turn_projected,
};
pub use residue::Residue;
pub use round::{approx, rational, round, round_rational, round_symbolic};
pub use rows::{Row, determinant_of_rows};
pub use sign::Sign;
pub use types::{Approx, Direction, Gradient, Linear, Plane, Point, Support, Zero};
