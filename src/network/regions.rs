//! Regions: which shells bound the same one, and what it is.
//!
//! A region is a part of the domain that hangs together across facets without a polygon. In a box, rays tell ([`super::rays`]).
//! On any domain, whatever vanishes where, regions are classes of these members: shells; free nodes ([`super::runs`]); cells of *special* simplices.
//!
//! Why shells and free nodes suffice elsewhere. A cell is convex, so the graph of its vertices and edges hangs together. Each of its edges is a wedge
//! between two of its polygons (joined around chains), or the side of a polygon on a facet, or a piece of an edge of the domain. At a vertex
//! the polygons of the cell follow one another around it, with a wedge between each two, except where a facet of the simplex comes between. On the
//! open facet that happens once around the vertex, so nothing is parted. On an edge of the domain where one plane passes the cell has the piece of the edge up to there
//! and one polygon, which are joined here. So all that the cell's boundary shows is in one class, if all its nodes are free and its vertices on edges
//! are such. If a simplex has one function (two materials) only, then each cell has a node where the function is not zero, which is free, and all
//! such nodes of the cell are joined by its edges; a polygon inside has a vertex on an edge between two of them, and one on a facet is joined
//! with the node opposite.
//! All other simplices with a vertex of the network at a node, or several planes through a point of an edge, are special; and those at nodes and edges
//! where the domain itself is not a manifold. Their cells are joined with their polygons, their free nodes, and across whole facets
//! without a polygon. (Across a part of a facet wedges do it: it has a side inside the facet, around which both cells and a polygon are.)
//!
//! Labels are read off one cell of each region.
//!
//! Cost: rays next to nothing. Else a few bits a node (boxes) or linear in the simplices (meshes), and linear in vertices on edges;
//! a complex for each special simplex and each region.

use super::local::{Local, Setting, Wall, active_functions};
use super::patches::{HalfPatch, Patches};
use super::rays;
use super::runs::{edge_vertices, find_runs, find_singular, join_runs, node_vertices};
use super::shells::Shells;
use super::simplex::{FaceSupport, LocalCell};
use super::{Domain, Kind};
use crate::base::parallel::{concat, map_ranges};
use crate::base::{Csr, Error, FunctionId, NodeId, PolygonId, RegionId, Result, ShellId, TetId, UnionFind, VertexId};
use crate::exact::Sign;

/// The regions of a network. Those with shells come first, by their lowest shells; parts of the domain that no polygon touches
/// follow, by their lowest nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Regions {
    /// The region of each shell.
    pub of_shell: Vec<RegionId>,
    /// The shells of each region, rising; none in a part of the domain that no polygon touches.
    pub shells: Csr<ShellId>,
    /// Arrangement: the sign of every function in each region, region by region.
    pub signs: Vec<Sign>,
    /// Interface: the material of each region.
    pub materials: Vec<FunctionId>,
    /// A simplex with a cell in each region.
    pub simplices: Vec<TetId>,
}

impl Regions {
    pub fn len(&self) -> usize {
        self.shells.len()
    }

    pub fn is_empty(&self) -> bool {
        self.shells.is_empty()
    }

    /// The region before one side of a polygon.
    #[inline]
    pub fn beside(&self, patches: &Patches, shells: &Shells, p: PolygonId, front: bool) -> RegionId {
        self.of_shell[shells.of(patches.side(p, front)).at()]
    }

    /// Arrangement: the signs of all functions in a region.
    pub fn signs_of(&self, region: RegionId) -> &[Sign] {
        let n = self.signs.len() / self.len();
        &self.signs[region.at() * n..(region.at() + 1) * n]
    }

    /// Each shell in one region; the labels on both sides of every polygon are those that its functions tell.
    pub fn check(&self, setting: &Setting, patches: &Patches, shells: &Shells) -> std::result::Result<(), String> {
        self.shells.check()?;
        let network = setting.network;
        if self.of_shell.len() != shells.len() || self.shells.items.len() != shells.len() {
            return Err("counts of regions differ".into());
        }
        let labels = match network.kind {
            Kind::Arrangement => self.signs.len() == self.len() * network.function_count,
            Kind::Interface => self.materials.len() == self.len(),
        };
        if !labels || self.simplices.len() != self.len() {
            return Err("counts of labels differ".into());
        }
        for (r, row) in self.shells.rows().enumerate() {
            if row.iter().any(|s| self.of_shell[s.at()].at() != r) || row.windows(2).any(|w| w[0] >= w[1]) {
                return Err(format!("shells of region {r}"));
            }
        }
        for p in 0..network.polygon_count() {
            let [front, back] = [true, false].map(|front| self.beside(patches, shells, PolygonId::of(p), front));
            let set = network.set_of(p);
            let right = match network.kind {
                Kind::Arrangement => {
                    let (a, b) = (self.signs_of(front), self.signs_of(back));
                    (0..network.function_count).all(|f| {
                        let item = set.iter().find(|item| item.function.at() == f);
                        match item {
                            Some(item) => Sign::from_ordering(a[f].cmp(&b[f])) == item.orientation,
                            None => a[f] == b[f],
                        }
                    })
                }
                Kind::Interface => {
                    let materials = [front, back].map(|r| self.materials[r.at()]);
                    set.iter().map(|item| item.function).eq(materials)
                }
            };
            if !right {
                return Err(format!("labels beside polygon {p}"));
            }
        }
        Ok(())
    }
}

/// How regions are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Method {
    /// Rays where they hold, else classes.
    #[default]
    Automatic,
    /// Free nodes, shells and special cells, whatever the domain.
    Classes,
}

/// A place in a region, for its label.
#[derive(Clone, Copy, Debug)]
enum Seed {
    /// Before one side of a polygon.
    Side(PolygonId, bool),
    /// A simplex that no polygon cuts.
    Whole(TetId),
}

/// Joins shells into regions and labels them.
pub fn find_regions(setting: &Setting, patches: &Patches, shells: &Shells, method: Method) -> Result<Regions> {
    let rays = if method == Method::Automatic { rays::shoot(setting, patches, shells) } else { None };
    let mut seeds = Vec::new();
    let mut whole = Vec::new();
    let mut classes = match rays {
        Some(classes) => {
            if shells.is_empty() {
                whole.push((shells.len(), TetId(0)));
            }
            classes
        }
        None => join_all(setting, patches, shells, &mut whole)?,
    };
    let mut regions = Regions::default();
    let mut number = vec![RegionId::NONE; classes.len()];
    for s in 0..shells.len() {
        let root = classes.find(s);
        if number[root].is_none() {
            number[root] = RegionId::of(seeds.len());
            let side = shells.half_patches.row(s)[0];
            seeds.push(Seed::Side(patches.lowest[side.patch().at()], side.front()));
        }
        regions.of_shell.push(number[root]);
    }
    for (member, tet) in whole {
        let root = classes.find(member);
        if number[root].is_none() {
            number[root] = RegionId::of(seeds.len());
            seeds.push(Seed::Whole(tet));
        }
    }
    let pairs = regions.of_shell.iter().enumerate().map(|(s, r)| (r.at(), ShellId::of(s)));
    regions.shells = Csr::from_pairs(seeds.len(), pairs);
    label(setting, &seeds, &mut regions)?;
    Ok(regions)
}

/// Reads the label of each region off a cell.
fn label(setting: &Setting, seeds: &[Seed], regions: &mut Regions) -> Result<()> {
    let network = setting.network;
    let n = network.function_count;
    let parts = map_ranges(seeds.len(), 64, |range| {
        let (mut local, mut walls) = (Local::default(), Vec::<Wall>::new());
        let (mut signs, mut materials, mut simplices) = (Vec::new(), Vec::new(), Vec::new());
        for seed in &seeds[range] {
            let tet = match *seed {
                Seed::Side(p, front) => network.polygon_tets[p.at()][!front as usize],
                Seed::Whole(tet) => tet,
            };
            local.build_once(setting, tet);
            let cell = match *seed {
                Seed::Side(p, front) => local.cell_beside(setting, p, front, &mut walls),
                Seed::Whole(_) => Some(LocalCell(0)),
            };
            let cell = cell.ok_or_else(|| Error::inconsistent("a polygon of the network is missing in its simplex"))?;
            simplices.push(tet);
            match network.kind {
                Kind::Arrangement => {
                    let start = signs.len();
                    signs.resize(start + n, Sign::Zero);
                    local.signs(setting, cell, &mut signs[start..]);
                }
                Kind::Interface => materials.push(local.owner(cell)),
            }
        }
        Ok((signs, (materials, simplices)))
    });
    let (signs, rest): (Vec<_>, Vec<_>) = parts.into_iter().collect::<Result<Vec<_>>>()?.into_iter().unzip();
    let (materials, simplices) = rest.into_iter().unzip();
    regions.signs = concat(signs);
    regions.materials = concat(materials);
    regions.simplices = concat(simplices);
    Ok(())
}

/// The classes of shells, runs of free nodes and special cells, in this order. `whole`: the members that may stand for regions without
/// shells, with a simplex of each.
fn join_all(
    setting: &Setting,
    patches: &Patches,
    shells: &Shells,
    whole: &mut Vec<(usize, TetId)>,
) -> Result<UnionFind> {
    let (network, domain) = (setting.network, setting.domain);
    let (singular_nodes, singular_edges) = match domain {
        Domain::Box(_) => Default::default(),
        Domain::Mesh(mesh) => find_singular(mesh),
    };
    let special = find_special(setting, patches, &singular_nodes, &singular_edges);
    let runs = find_runs(network, domain, &singular_nodes);
    let base = shells.len();
    let cells = Cells::count(setting, &special, base + runs.count());
    let mut classes = UnionFind::new(cells.end());
    join_runs(&runs, network, domain, base, &mut classes);
    let node = |n: NodeId| runs.member(n).map(|m| base + m);
    let shell = |h: HalfPatch| shells.of(h).at();

    // Along edges of the domain: node, vertex, vertex, ..., node.
    for ([low, high], range) in edge_vertices(network) {
        if singular_edges.binary_search(&[low, high]).is_ok() {
            continue;
        }
        let mut before = node(low);
        for v in range.map(VertexId::of) {
            let sides = [low, high].map(|n| rays::looking_to(setting, patches, v, n).map(shell));
            if let (Some(a), Some(b)) = (before, sides[0]) {
                classes.union(a, b);
            }
            before = sides[1];
        }
        if let (Some(a), Some(b)) = (before, node(high)) {
            classes.union(a, b);
        }
    }
    // Polygons on facets.
    for (p, tets) in network.polygon_tets.iter().enumerate() {
        if tets[0] == tets[1] {
            continue;
        }
        for (side, &tet) in tets.iter().enumerate() {
            if special.binary_search(&tet).is_err() {
                let other = domain.corners(tets[1 - side]);
                let opposite = domain.corners(tet).into_iter().find(|n| !other.contains(n));
                let opposite = opposite.and_then(node).ok_or_else(|| lost(tet))?;
                classes.union(shell(patches.side(PolygonId::of(p), side == 0)), opposite);
            }
        }
    }
    join_special(setting, patches, &special, &cells, &node, &shell, &mut classes)?;

    let mut around = Vec::new();
    for (member, n) in runs.members() {
        domain.around(&[n], &mut around);
        whole.push((base + member, around[0]));
    }
    for (s, &tet) in special.iter().enumerate() {
        whole.push((cells.first[s] as usize, tet));
    }
    Ok(classes)
}

fn lost(tet: TetId) -> Error {
    Error::inconsistent(format!("the network contradicts itself in simplex {}", tet.0))
}

/// The special simplices, rising.
fn find_special(
    setting: &Setting,
    patches: &Patches,
    singular_nodes: &[NodeId],
    singular_edges: &[[NodeId; 2]],
) -> Vec<TetId> {
    let (network, domain) = (setting.network, setting.domain);
    let (mut special, mut around) = (Vec::new(), Vec::new());
    let add = |nodes: &[NodeId], around: &mut Vec<TetId>, list: &mut Vec<TetId>| {
        domain.around(nodes, around);
        list.extend_from_slice(around);
    };
    node_vertices(network).for_each(|n| add(&[n], &mut around, &mut special));
    for (nodes, range) in edge_vertices(network) {
        let tied = |v: usize| rays::looking_to(setting, patches, VertexId::of(v), nodes[0]).is_none();
        if range.into_iter().any(tied) {
            add(&nodes, &mut around, &mut special);
        }
    }
    special.sort_unstable();
    special.dedup();
    // One function that is not zero everywhere in it, or two materials: plain.
    let parts = map_ranges(special.len(), 1 << 10, |range| {
        let mut functions = Vec::new();
        let mut is_special = |tet: TetId| {
            let corners = domain.corners(tet);
            let corners = &corners[..=domain.dim()];
            active_functions(setting, corners, &mut functions);
            let value = |f: FunctionId, n: NodeId| setting.values.at(f, n);
            match (network.kind, &functions[..]) {
                (Kind::Arrangement, []) | (Kind::Interface, [] | [_]) => false,
                (Kind::Arrangement, &[f]) => corners.iter().all(|&n| value(f, n) == 0.0),
                // (Equal on a facet, they may have one owner on both sides of it: no polygon, and no free node there.)
                (Kind::Interface, &[f, g]) => {
                    corners.iter().filter(|&&n| value(f, n) == value(g, n)).count() >= domain.dim()
                }
                _ => true,
            }
        };
        special[range].iter().copied().filter(|&tet| is_special(tet)).collect()
    });
    let mut special = concat(parts);
    singular_nodes.iter().for_each(|&n| add(&[n], &mut around, &mut special));
    singular_edges.iter().for_each(|nodes| add(nodes, &mut around, &mut special));
    special.sort_unstable();
    special.dedup();
    special
}

/// Members for the cells of special simplices.
struct Cells {
    /// The first member of each simplex, and the end.
    first: Vec<u32>,
}

impl Cells {
    fn count(setting: &Setting, special: &[TetId], base: usize) -> Self {
        let counts = concat(map_ranges(special.len(), 256, |range| {
            let mut local = Local::default();
            special[range]
                .iter()
                .map(|&tet| {
                    local.build(setting, tet);
                    local.complex.cell_count() as u32
                })
                .collect()
        }));
        let mut first = vec![base as u32];
        let mut sum = base as u32;
        first.extend(counts.iter().map(|n| {
            sum += n;
            sum
        }));
        Self { first }
    }
    fn end(&self) -> usize {
        self.first[self.first.len() - 1] as usize
    }
    fn member(&self, s: usize, cell: LocalCell) -> usize {
        self.first[s] as usize + cell.at()
    }
}

/// Joins the cells of special simplices with their polygons and free nodes, and with one another.
fn join_special(
    setting: &Setting,
    patches: &Patches,
    special: &[TetId],
    cells: &Cells,
    node: &impl Fn(NodeId) -> Option<usize>,
    shell: &impl Fn(HalfPatch) -> usize,
    classes: &mut UnionFind,
) -> Result<()> {
    if special.is_empty() {
        return Ok(());
    }
    let (network, domain) = (setting.network, setting.domain);
    let dim = domain.dim();
    let sides = network.polygon_tets.iter().enumerate().flat_map(|(p, tets)| {
        [0, 1].into_iter().filter_map(move |side| {
            let s = special.binary_search(&tets[side]).ok()?;
            Some((s, (PolygonId::of(p), side == 0)))
        })
    });
    let sides: Csr<(PolygonId, bool)> = Csr::from_pairs(special.len(), sides);
    // The cell at each facet that is whole, and has no polygon.
    let mut at_facet = vec![[u32::MAX; 4]; special.len()];
    let (mut local, mut walls) = (Local::default(), Vec::new());
    for (s, &tet) in special.iter().enumerate() {
        local.build(setting, tet);
        for &(p, front) in sides.row(s) {
            let cell = local.cell_beside(setting, p, front, &mut walls).ok_or_else(|| lost(tet))?;
            classes.union(shell(patches.side(p, front)), cells.member(s, cell));
        }
        let complex = &local.complex;
        let mut pieces = [0; 4];
        for f in 0..complex.face_count() {
            let FaceSupport::Facet(facet) = complex.face_support[f] else { continue };
            let cell = complex.face_cells[f][0];
            pieces[facet as usize] += 1;
            at_facet[s][facet as usize] = cells.member(s, cell) as u32;
            for v in complex.face_vertices.row(f) {
                let carrier = complex.vertex_carrier[v.at()];
                if carrier.dim() == 0
                    && let Some(member) = node(local.corners[carrier.0.trailing_zeros() as usize])
                {
                    classes.union(cells.member(s, cell), member);
                }
            }
        }
        for facet in 0..=dim {
            let Some((other, _)) = domain.opposite(tet, facet) else { continue };
            let has_polygon = |&(p, _): &(PolygonId, bool)| network.polygon_tets[p.at()].contains(&other);
            if pieces[facet] > 1 || sides.row(s).iter().any(has_polygon) {
                at_facet[s][facet] = u32::MAX;
                continue;
            }
            // Joined from the later one of the two.
            if other < tet
                && let Ok(o) = special.binary_search(&other)
                && let Some(back) = (0..=dim).find(|&k| domain.opposite(other, k).is_some_and(|(t, _)| t == tet))
            {
                if at_facet[o][back] == u32::MAX {
                    return Err(lost(tet));
                }
                classes.union(at_facet[o][back] as usize, at_facet[s][facet] as usize);
            }
        }
    }
    Ok(())
}
