//! Vectors of three doubles, for what only proposes: results are rounded, nothing exact follows from them.

pub fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// In range wherever the result is. (`hypot` is the platform's, and may round otherwise on another one.)
pub fn length(a: [f64; 3]) -> f64 {
    let most = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if most == 0.0 || !most.is_finite() {
        return a.iter().map(|x| x.abs()).sum();
    }
    let a = a.map(|x| x / most);
    most * dot(a, a).sqrt()
}
