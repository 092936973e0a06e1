//! Readers, and whole files against what other programs say of them.

mod common;
use common::*;
use lapidary::base::DefectKind;
use lapidary::mesh::MeshOptions;

#[test]
fn off_headers_comments_fans_and_merging() {
    let text = "# a comment\nCOFF # another\n5 2 0\n0 0 0 255 0 0 255\n1 0 0 0 0 0 0\n\n1 1 0 0 0 0 0\n0 1 0 1 1 1 1\n-0 0 -0.0 1 1 1 1\n4 0 1 2 3 255 0 0\n3 4 2 1\n";
    let soup = parse_off(text).unwrap();
    assert_eq!(soup.vertices, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(soup.triangles, [[0, 1, 2], [0, 2, 3], [0, 2, 1]]);
    assert_eq!(parse_off("OFF 1 0 0\n0.1 1e-320 2\n").unwrap().vertices, [[0.1, 1e-320, 2.0]]);
    assert!(parse_off("PLY\n1 0 0\n").is_err());
    assert!(parse_off("OFF\n2 0 0\n1 2 3\n").is_err());
    assert!(parse_off("OFF\n1 0 0\n1 2\n").is_err());
}

#[test]
fn obj_indices() {
    let text = "v 0 0 0\nv 1 0 0 # c\nvn 0 0 1\nv 0 1 0\nv 0 0 1\nf 1//1 2/3 3\nf -4 -3 -1\n";
    let soup = parse_obj(text).unwrap();
    assert_eq!(soup.triangles, [[0, 1, 2], [0, 1, 3]]);
    assert_eq!(soup.vertices.len(), 4);
}

#[test]
fn every_off_file_can_be_read() {
    let Some(dir) = cgal_meshes() else { return };
    let mut paths: Vec<_> = std::fs::read_dir(dir).unwrap().map(|e| e.unwrap().path()).collect();
    paths.retain(|p| p.extension().is_some_and(|e| e == "off"));
    paths.sort();
    let failed: Vec<String> = paths.iter().filter_map(|p| read_off(p).err()).collect();
    assert!(failed.is_empty(), "{failed:#?}");
    assert!(paths.len() > 100, "only {} files", paths.len());
}

/// A number field of one entry of the list of meshes, which is flat enough to be read without a parser.
fn field<'a>(entry: &'a str, name: &str) -> &'a str {
    let start = entry.find(&format!("\"{name}\"")).unwrap_or_else(|| panic!("no {name} in {entry}"));
    let value = entry[start..].split_once(':').unwrap().1;
    value.split([',', '}']).next().unwrap().trim().trim_matches('"')
}

/// Gives every umbrella of triangles at a vertex a vertex of its own, as programs do whose data structure needs manifolds;
/// in theirs, umbrellas that meet at a point are in contact.
fn split_umbrellas(soup: &Soup) -> Soup {
    let mut corners_of: Vec<Vec<(usize, usize)>> = vec![Vec::new(); soup.vertices.len()];
    for (t, c) in soup.triangles.iter().enumerate() {
        (0..3).for_each(|k| corners_of[c[k] as usize].push((t, k)));
    }
    let mut split = soup.clone();
    for corners in corners_of {
        let mut free: Vec<(usize, usize)> = corners;
        let mut first = true;
        while let Some(start) = free.pop() {
            let mut umbrella = vec![start];
            let mut i = 0;
            while i < umbrella.len() {
                let (t, k) = umbrella[i];
                let rim = [soup.triangles[t][(k + 1) % 3], soup.triangles[t][(k + 2) % 3]];
                let (joined, rest) = free.into_iter().partition(|&(u, l)| {
                    let other = [soup.triangles[u][(l + 1) % 3], soup.triangles[u][(l + 2) % 3]];
                    other.iter().any(|v| rim.contains(v))
                });
                free = rest;
                umbrella.extend::<Vec<_>>(joined);
                i += 1;
            }
            if !first {
                let own = split.vertices.len() as i32;
                split.vertices.push(soup.vertices[soup.triangles[start.0][start.1] as usize]);
                umbrella.iter().for_each(|&(t, k)| split.triangles[t][k] = own);
            }
            first = false;
        }
    }
    split
}

/// Closed, but facing inward: solids face outward here, so they need turning first.
const INWARD: [&str; 3] = ["tetrahedron.off", "beam.off", "ellipe0.003.off"];

#[test]
fn closed_meshes_as_others_count_them() {
    let (Some(dir), Some(list)) = (cgal_meshes(), shared("oracles/closed-meshes.json")) else { return };
    let text = std::fs::read_to_string(list).unwrap();
    let entries: Vec<&str> = text.split('{').filter(|e| e.contains("\"file\"")).collect();
    assert_eq!(entries.len(), 79);
    let mut failed = Vec::new();
    for entry in entries {
        let file = field(entry, "file");
        if !file.ends_with(".off") {
            continue;
        }
        let count = |name: &str| field(entry, name).parse::<usize>().unwrap();
        let mut soup = read_off(&dir.join(file)).unwrap();
        if INWARD.contains(&file) {
            let kinds: Vec<DefectKind> = defects(&soup, checking()).iter().map(|c| c.kind).collect();
            assert_eq!(kinds, [DefectKind::WrongNesting], "{file}");
            soup = flipped(soup);
        }
        let checked = build_soup(&split_umbrellas(&soup), checking());
        let found = checked.map_or_else(|e| e.culprits, |_| Vec::new());
        let pairs = found.iter().filter(|c| c.kind == DefectKind::SelfIntersection).count();
        if pairs != count("self_intersecting_pairs") {
            failed.push(format!("{file}: {pairs} pairs, {entry}"));
        }
        match build_soup(&soup, MeshOptions::default()) {
            Ok(mesh) => {
                mesh.check().unwrap();
                let euler = (mesh.vertices.len() + mesh.triangles.len()) as i64 - mesh.edges.len() as i64;
                let ours = (mesh.vertices.len(), mesh.triangles.len(), euler, mesh.component_count);
                let theirs = (count("vertices"), count("triangles"), field(entry, "euler"), count("components"));
                if ours != (theirs.0, theirs.1, theirs.2.parse().unwrap(), theirs.3) {
                    failed.push(format!("{file}: {ours:?}, {theirs:?}"));
                }
            }
            // Components that cross one another need not nest.
            Err(e) if pairs > 0 && e.culprits.iter().all(|c| c.kind == DefectKind::WrongNesting) => {}
            Err(e) => failed.push(format!("{file}: {e}")),
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}
