//! Times the parts of networks: `cargo bench --bench network -- PART ARGUMENTS`.
//!
//! - `grid FILE N [THREADS [REPEATS [ia|mi]]]`: vertices and polygons of the functions of a file on a box of N³ cubes.
//! - `degeneracies [COUNT]`: how often near-degenerate inputs give the same complex in two orders (Table 1 of the paper); with
//!   `--features plain-signs` also if signs are those of plain doubles.
//! - `shifted [COUNT [N]]`: the same for four spheres shifted by next to nothing on a box of N³ cubes (Table 2).
//! - `regions FILE N [THREADS [REPEATS [ia|mi]]]`: the same, and all that the polygons form.
//! - `tables [NAME]`: nanoseconds per look-up of one simplex.
//! - `simplex [NAME]`: microseconds per arrangement and interface of one simplex, incremental.

#[path = "network/degeneracies.rs"]
mod degeneracies;
#[path = "network/grid.rs"]
mod grid;
#[path = "network/shifted.rs"]
mod shifted;
#[path = "network/simplex.rs"]
mod simplex;
#[path = "network/tables.rs"]
mod tables;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    match arguments.first().map(String::as_str) {
        Some("grid") => grid::main(&arguments[1..], false),
        Some("regions") => grid::main(&arguments[1..], true),
        Some("degeneracies") => degeneracies::main(&arguments[1..]),
        Some("shifted") => shifted::main(&arguments[1..]),
        Some("simplex") => simplex::main(&arguments[1..]),
        Some("tables") => tables::main(&arguments[1..]),
        _ => println!(
            "usage: network (grid | regions) FILE N [THREADS [REPEATS [ia|mi]]] | simplex [NAME] | tables [NAME] \
             | degeneracies [COUNT] | shifted [COUNT [N]]"
        ),
    }
}
