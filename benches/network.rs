//! Times the parts of networks: `cargo bench --bench network -- PART ARGUMENTS`.
//!
//! - `grid FILE N [THREADS [REPEATS [ia|mi]]]`: vertices and polygons of the functions of a file on a box of N³ cubes.

#[path = "network/grid.rs"]
mod grid;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    match arguments.first().map(String::as_str) {
        Some("grid") => grid::main(&arguments[1..]),
        _ => println!("usage: network grid FILE N [THREADS [REPEATS [ia|mi]]]"),
    }
}
