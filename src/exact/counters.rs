//! How many decisions each tier took, per predicate. Thread-local, off by default: an unused counter costs one
//! thread-local load and a branch. Each thread that shall count is enabled by itself; its counts are taken from it and merged.

use std::cell::{Cell, RefCell};

macro_rules! predicates {
    ($($(#[$doc:meta])* $name:ident = $text:literal),* $(,)?) => {
        /// What was decided.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        #[repr(usize)]
        pub enum Predicate { $($(#[$doc])* $name),* }
        pub const PREDICATES: [Predicate; [$($text),*].len()] = [$(Predicate::$name),*];
        const PREDICATE_NAMES: [&str; PREDICATES.len()] = [$($text),*];
    };
}

predicates! {
    /// Side of an input vertex and a plane.
    Side = "side",
    /// Order of two planes along a mesh edge.
    EdgeOrder = "edge_order",
    /// Order of three planes in a triangle.
    TriangleOrder = "triangle_order",
    /// Side of a symbolic point and a support.
    PointSide = "point_side",
    /// Order of two symbolic points along an axis.
    CoordinateOrder = "coordinate_order",
    /// Determinant or scalar product of directions.
    Direction = "direction",
    /// Order of directions around a vertex in a support.
    CyclicOrder = "cyclic_order",
    /// Order of half-planes around an edge.
    RadialOrder = "radial_order",
    /// Side of a vertex and a triangle; collinearity.
    Orient3d = "orient3d",
    /// Turn of three symbolic points in an axis-parallel projection; order of central projections.
    Projected = "projected",
    /// Order of planes along the line of two others.
    PointOrder = "point_order",
    /// Whether a loop is an outer loop or a hole.
    LoopOrientation = "loop_orientation",
    /// Determinant of function values in a simplex.
    Barycentric = "barycentric",
    /// The nearest double of a coordinate.
    Rounding = "rounding",
}

/// Who decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(usize)]
pub enum Tier {
    /// What was known already; no arithmetic on coordinates.
    Topology,
    /// A static or semi-static filter, or one exact comparison of doubles.
    Filter,
    /// A value with a running error bound.
    Bounded,
    /// Integers on the stack.
    Exact,
    /// Integers of any size.
    Big,
}

pub const TIERS: [Tier; 5] = [Tier::Topology, Tier::Filter, Tier::Bounded, Tier::Exact, Tier::Big];

impl Predicate {
    pub fn name(self) -> &'static str {
        PREDICATE_NAMES[self as usize]
    }
}

impl Tier {
    pub fn name(self) -> &'static str {
        ["topology", "filter", "bounded", "exact", "big"][self as usize]
    }
}

/// Decisions per predicate and tier.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Counts(pub [[u64; TIERS.len()]; PREDICATES.len()]);

impl Counts {
    pub const ZERO: Self = Self([[0; TIERS.len()]; PREDICATES.len()]);

    pub fn get(&self, p: Predicate, t: Tier) -> u64 {
        self.0[p as usize][t as usize]
    }
    /// All predicates together.
    pub fn tier(&self, t: Tier) -> u64 {
        self.0.iter().map(|row| row[t as usize]).sum()
    }
    pub fn merge(&mut self, o: &Counts) {
        for (row, other) in self.0.iter_mut().zip(&o.0) {
            for (x, y) in row.iter_mut().zip(other) {
                *x += y;
            }
        }
    }
}

thread_local! {
    static ON: Cell<bool> = const { Cell::new(false) };
    static COUNTS: RefCell<Counts> = const { RefCell::new(Counts::ZERO) };
}

/// Switches counting on this thread on or off.
pub fn enable(on: bool) {
    ON.set(on);
}

pub fn enabled() -> bool {
    ON.get()
}

/// This thread's counts so far; they start again at zero.
pub fn take() -> Counts {
    COUNTS.take()
}

#[inline(always)]
pub fn count(p: Predicate, t: Tier) {
    if ON.get() {
        add(p, t, 1);
    }
}

/// For engines: a decision that followed from what was known.
#[inline(always)]
pub fn count_topology(p: Predicate) {
    count(p, Tier::Topology);
}

/// For engines: a decision that one certified comparison of doubles took.
#[inline(always)]
pub fn count_filter(p: Predicate) {
    count(p, Tier::Filter);
}

/// For engines: `n` decisions at once, of bulk passes.
#[inline(always)]
pub fn count_many(p: Predicate, t: Tier, n: u64) {
    if ON.get() {
        add(p, t, n);
    }
}

#[cold]
fn add(p: Predicate, t: Tier, n: u64) {
    COUNTS.with_borrow_mut(|c| c.0[p as usize][t as usize] += n);
}
