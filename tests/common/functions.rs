//! Functions of space, from JSON lists of spheres, and their values at the nodes of a box.
#![allow(dead_code)]

use lapidary::base::NodeId;
use lapidary::network::BoxGrid;
use std::path::Path;

/// Positive inside: r − |x − c|.
#[derive(Clone, Copy)]
pub struct Sphere {
    pub center: [f64; 3],
    pub radius: f64,
}

impl Sphere {
    pub fn at(&self, x: &[f64; 3]) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|i| x[i] - self.center[i]);
        self.radius - (x * x + y * y + z * z).sqrt()
    }
}

pub fn read_spheres(path: &Path) -> Vec<Sphere> {
    let text = std::fs::read_to_string(path).expect("a readable file");
    let list: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let number = |x: &serde_json::Value| x.as_f64().expect("a number");
    let sphere = |f: &serde_json::Value| {
        assert_eq!(f["type"], "sphere");
        Sphere { center: [0, 1, 2].map(|i| number(&f["center"][i])), radius: number(&f["radius"]) }
    };
    list.as_array().expect("a list").iter().map(sphere).collect()
}

/// One array per function.
pub fn evaluate(grid: &BoxGrid, functions: &[impl Fn(&[f64; 3]) -> f64]) -> Vec<Vec<f64>> {
    let nodes = grid.node_count();
    functions.iter().map(|f| (0..nodes).map(|n| f(&grid.coordinates(NodeId::of(n)))).collect()).collect()
}

pub fn sphere_values(grid: &BoxGrid, spheres: &[Sphere]) -> Vec<Vec<f64>> {
    let functions: Vec<_> = spheres.iter().map(|s| move |x: &[f64; 3]| s.at(x)).collect();
    evaluate(grid, &functions)
}
