//! What holds for the vertices and polygons of every network, whatever the input. For tests and debug builds: time of a sort of all edges.

use super::data::{Network, Values};
use super::domain::Domain;
use super::simplex::Kind;
use crate::base::{FunctionId, NodeId, TetId, VertexId};
use crate::exact::Sign;

/// One use of an edge by a polygon.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Use {
    /// Lower vertex first.
    ends: [VertexId; 2],
    polygon: u32,
    /// Walked from the lower vertex to the higher.
    forward: bool,
}

impl Network {
    /// The arrays fit together; vertices lie on their carriers, are used, and know their functions; polygons lie in their simplices, on their functions; and around
    /// every edge inside the domain the labels come back to where they started: for each function (material) the polygons whose crossing makes it rise are as
    /// many as those that make it fall. (Functions that vanish on whole simplices, where a sign has three values, are left out.)
    pub fn check(&self, domain: &Domain, values: &Values) -> Result<(), String> {
        self.check_arrays()?;
        self.check_vertices(domain, values)?;
        self.check_polygons(domain)?;
        self.check_edges(domain, values)
    }

    fn check_arrays(&self) -> Result<(), String> {
        self.vertex_functions.check()?;
        self.polygons.check()?;
        self.sets.check()?;
        let (v, p) = (self.vertices.len(), self.polygon_set.len());
        if self.vertex_nodes.len() != v || self.vertex_functions.len() != v {
            return Err("arrays of vertices differ in length".into());
        }
        if self.polygons.len() != p || self.polygon_tets.len() != p {
            return Err("arrays of polygons differ in length".into());
        }
        if self.polygons.items.iter().any(|x| x.at() >= v) || self.polygon_set.iter().any(|s| s.at() >= self.sets.len())
        {
            return Err("a polygon refers to what is not there".into());
        }
        let mut used = vec![false; v];
        self.polygons.items.iter().for_each(|x| used[x.at()] = true);
        if let Some(x) = used.iter().position(|u| !u) {
            return Err(format!("vertex {x} is on no polygon"));
        }
        let mut used = vec![false; self.sets.len()];
        self.polygon_set.iter().for_each(|s| used[s.at()] = true);
        let rising = (1..self.sets.len()).all(|s| self.sets.row(s - 1) < self.sets.row(s));
        if used.contains(&false) || !rising {
            return Err("sets are not all used, different and in order".into());
        }
        for (s, set) in self.sets.rows().enumerate() {
            let first = set.iter().map(|item| item.orientation).find(|o| !o.is_zero());
            let oriented = match self.kind {
                Kind::Arrangement => first.is_none_or(|o| o == Sign::Positive),
                Kind::Interface => {
                    matches!(set, [a, b] if a.orientation == Sign::Positive && b.orientation == Sign::Negative)
                }
            };
            if set.is_empty() || !oriented || set.windows(2).any(|w| w[0].function >= w[1].function) {
                return Err(format!("set {s} is not sorted or not oriented"));
            }
        }
        Ok(())
    }

    fn check_vertices(&self, domain: &Domain, values: &Values) -> Result<(), String> {
        let mut around = Vec::new();
        for v in 0..self.vertices.len() {
            let nodes = &self.vertex_nodes[v];
            let count = nodes.iter().filter(|n| n.is_some()).count();
            if count == 0
                || nodes[..count].windows(2).any(|w| w[0] >= w[1])
                || nodes[count..].iter().any(|n| n.is_some())
            {
                return Err(format!("the nodes of vertex {v} are not sorted"));
            }
            domain.around(&nodes[..count], &mut around);
            if around.is_empty() {
                return Err(format!("the nodes of vertex {v} have no simplex in common"));
            }
            let places: Vec<[f64; 3]> = nodes[..count].iter().map(|&n| domain.coordinates(n)).collect();
            for axis in 0..3 {
                let low = places.iter().map(|x| x[axis]).fold(f64::INFINITY, f64::min);
                let high = places.iter().map(|x| x[axis]).fold(f64::NEG_INFINITY, f64::max);
                // Rounding is monotonous.
                if !(low..=high).contains(&self.vertices[v][axis]) {
                    return Err(format!("vertex {v} is outside of its carrier"));
                }
            }
            let functions = self.vertex_functions.row(v);
            if functions.windows(2).any(|w| w[0] >= w[1]) || functions.iter().any(|f| f.at() >= self.function_count) {
                return Err(format!("the functions of vertex {v} are not sorted"));
            }
            // Every function that could vanish, by its signs at the nodes, or surely does.
            let signs = |f: FunctionId| nodes[..count].iter().map(move |&n| Sign::of(values.at(f, n)));
            if self.kind == Kind::Arrangement {
                for f in (0..self.function_count).map(FunctionId::of) {
                    let listed = functions.binary_search(&f).is_ok();
                    let (low, high) = (signs(f).min().unwrap(), signs(f).max().unwrap());
                    let zero = low.is_zero() && high.is_zero();
                    if zero && !listed || listed && !zero && (low, high) != (Sign::Negative, Sign::Positive) {
                        return Err(format!("function {} at vertex {v}", f.0));
                    }
                }
            }
            if functions.len() < count.max(1) - (self.kind == Kind::Arrangement && count > 1) as usize {
                return Err(format!("vertex {v} has too few functions"));
            }
        }
        let mut order: Vec<usize> = (0..self.vertices.len()).collect();
        let key = |v: usize| (&self.vertex_nodes[v], self.vertex_functions.row(v));
        order.sort_unstable_by(|&a, &b| key(a).cmp(&key(b)));
        match order.windows(2).find(|w| key(w[0]) == key(w[1])) {
            Some(w) => Err(format!("vertices {} and {} are the same point", w[0], w[1])),
            None => Ok(()),
        }
    }

    fn check_polygons(&self, domain: &Domain) -> Result<(), String> {
        for p in 0..self.polygon_set.len() {
            let row = self.polygons.row(p);
            let mut sorted = row.to_vec();
            sorted.sort_unstable();
            sorted.dedup();
            if sorted.len() != row.len() || row.len() < self.dim || (self.dim == 2 && row.len() > 2) {
                return Err(format!("polygon {p} has a bad loop"));
            }
            let [a, b] = self.polygon_tets[p];
            let corners = [a, b].map(|t| domain.corners(t));
            let common = corners[0].iter().filter(|n| n.is_some() && corners[1].contains(n)).count();
            if a != b && common != self.dim {
                return Err(format!("polygon {p} is between simplices that are not neighbours"));
            }
            for v in row {
                let inside = |n: &NodeId| n.is_none() || (corners[0].contains(n) && corners[1].contains(n));
                if !self.vertex_nodes[v.at()].iter().all(inside) {
                    return Err(format!("polygon {p} leaves its simplices"));
                }
                let functions = self.vertex_functions.row(*v);
                if !self.set_of(p).iter().all(|item| functions.binary_search(&item.function).is_ok()) {
                    return Err(format!("polygon {p} has a function that does not vanish at vertex {}", v.0));
                }
            }
        }
        Ok(())
    }

    fn check_edges(&self, domain: &Domain, values: &Values) -> Result<(), String> {
        let mut zero_somewhere = vec![false; self.function_count];
        if self.kind == Kind::Arrangement {
            for t in 0..domain.tet_count() {
                let corners = domain.corners(TetId::of(t));
                for (f, zero) in zero_somewhere.iter_mut().enumerate() {
                    *zero |= corners[..=self.dim].iter().all(|&n| values.at(FunctionId::of(f), n) == 0.0);
                }
            }
        }
        // In two dimensions an "edge" is an end of a segment.
        let mut uses = Vec::new();
        for p in 0..self.polygon_set.len() {
            let row = self.polygons.row(p);
            for (i, &v) in row.iter().enumerate() {
                let next = if self.dim == 2 { v } else { row[(i + 1) % row.len()] };
                let forward = if self.dim == 2 { i == 0 } else { v < next };
                uses.push(Use { ends: [v.min(next), v.max(next)], polygon: p as u32, forward });
            }
        }
        uses.sort_unstable();
        let (mut around, mut sums) = (Vec::new(), vec![0i32; self.function_count]);
        for same in uses.chunk_by(|a, b| a.ends == b.ends) {
            for u in same {
                for item in self.set_of(u.polygon as usize) {
                    let step = item.orientation.to_i8() as i32;
                    sums[item.function.at()] += if u.forward { step } else { -step };
                }
            }
            let unbalanced = same.iter().flat_map(|u| self.set_of(u.polygon as usize));
            let unbalanced = unbalanced.map(|item| item.function.at()).find(|&f| sums[f] != 0 && !zero_somewhere[f]);
            if let Some(f) = unbalanced
                && !self.on_boundary(domain, same[0].ends, &mut around)
            {
                let [a, b] = same[0].ends;
                return Err(format!("around the edge from vertex {} to {}, function {f} does not come back", a.0, b.0));
            }
            for u in same {
                self.set_of(u.polygon as usize).iter().for_each(|item| sums[item.function.at()] = 0);
            }
        }
        Ok(())
    }

    /// Whether the smallest sub-simplex that holds two vertices is on the boundary of the domain.
    fn on_boundary(&self, domain: &Domain, ends: [VertexId; 2], around: &mut Vec<TetId>) -> bool {
        let mut nodes: Vec<NodeId> =
            ends.iter().flat_map(|v| self.vertex_nodes[v.at()]).filter(|n| n.is_some()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        domain.around(&nodes, around);
        around.iter().any(|&t| {
            let corners = domain.corners(t);
            (0..=self.dim).any(|i| !nodes.contains(&corners[i]) && domain.opposite(t, i).is_none())
        })
    }
}
