//! The committed header: it compiles in each language it is for, uses ABI types only, every function is tested from C and
//! documented, and the shared library exports just that.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn header() -> String {
    std::fs::read_to_string(root().join("include/lapidary.h")).unwrap()
}

/// The declarations of functions, each on one line: name and parameters.
fn functions() -> Vec<(String, String)> {
    let text = header();
    let mut found = Vec::new();
    // Declarations are the only lines outside comments that start with `int32_t lap_`.
    for (start, _) in text.match_indices("\nint32_t lap_") {
        let rest = &text[start + 1..];
        let declaration = rest[..rest.find(';').unwrap()].split_whitespace().collect::<Vec<_>>().join(" ");
        let (name, parameters) = declaration.strip_prefix("int32_t ").unwrap().split_once('(').unwrap();
        found.push((name.to_string(), parameters.trim_end_matches(')').to_string()));
    }
    assert!(found.len() > 40, "only {} functions found in the header", found.len());
    found
}

/// The system's compiler for this target.
fn compiler(cpp: bool) -> Command {
    let target = env!("LAPIDARY_TARGET");
    let mut build = cc::Build::new();
    build.cpp(cpp).target(target).host(target).opt_level(0).debug(false).cargo_metadata(false).warnings(false);
    build.get_compiler().to_command()
}

fn compiles(cpp: bool, standard: &str, source: &str) {
    let file =
        Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("header-{standard}.{}", if cpp { "cpp" } else { "c" }));
    std::fs::write(&file, source).unwrap();
    let output = compiler(cpp)
        .args(["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only"])
        .arg(format!("-std={standard}"))
        .arg("-I")
        .arg(root().join("include"))
        .arg(&file)
        .output()
        .unwrap();
    assert!(output.status.success(), "{standard}: {}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn the_header_compiles_as_c99_c11_and_cpp17() {
    // Twice: the include guard.
    let source = "#include \"lapidary.h\"\n#include \"lapidary.h\"\nint main(void) { return LAP_OK; }\n";
    compiles(false, "c99", source);
    compiles(false, "c11", source);
    compiles(true, "c++17", source);
    compiles(true, "c++17", "#include \"lapidary.hpp\"\n#include \"lapidary.h\"\nint main() { return LAP_OK; }\n");
}

#[test]
fn signatures_use_abi_types_only() {
    let allowed = ["int32_t", "int64_t", "double", "uint8_t", "char", "void"];
    for (name, parameters) in functions() {
        for parameter in parameters.split(", ") {
            let words: Vec<&str> = parameter.split([' ', '*']).filter(|w| !w.is_empty() && *w != "const").collect();
            let ok = match words[..] {
                ["struct", noun, _] => noun.starts_with("lap_") && parameter.contains('*'),
                // Callbacks.
                ["lap_progress" | "lap_log" | "lap_choose" | "lap_inside", _] => true,
                ["void", user] => user == "user" && parameter.contains('*'),
                [base, _] => allowed.contains(&base),
                _ => false,
            };
            assert!(ok, "{name}: {parameter}");
        }
    }
}

#[test]
fn every_function_says_its_errors_and_comes_with_a_test() {
    let text = header();
    let mut tests = String::new();
    for entry in std::fs::read_dir(root().join("c_tests/api")).unwrap() {
        tests += &std::fs::read_to_string(entry.unwrap().path()).unwrap();
    }
    for (name, _) in functions() {
        let declared = text.find(&format!("\nint32_t {name}(")).unwrap();
        let comment = &text[text[..declared].rfind("/*").unwrap()..declared];
        assert!(comment.contains("Errors:"), "{name} does not say which errors it has");
        assert!(tests.contains(&format!("{name}(")), "{name} is not called by c_tests/api");
    }
}

/// The shared library of the profile that this test was built with.
/// All words that begin with `lap_` or `LAP_`.
fn names(text: &str) -> BTreeSet<&str> {
    let part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.split(|c| !part(c)).filter(|w| w.to_ascii_lowercase().starts_with("lap_")).collect()
}

#[test]
fn comments_name_only_what_there_is() {
    let text = header();
    let (mut code, mut comments) = (String::new(), String::new());
    for piece in text.split_inclusive("*/") {
        let (before, comment) = piece.split_once("/*").unwrap_or((piece, ""));
        code += before;
        comments += comment;
    }
    let declared = names(&code);
    assert!(declared.len() > 200, "{}", declared.len());
    // Patterns end with an underscore, or are about any noun.
    let pattern = |n: &&str| n.ends_with('_') || n.starts_with("lap_noun_");
    let missing: Vec<&str> = names(&comments).into_iter().filter(|n| !pattern(n) && !declared.contains(n)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

fn library() -> PathBuf {
    let mut dir = std::env::current_exe().unwrap();
    dir.pop();
    dir.pop();
    dir.join("liblapidary.so")
}

#[test]
fn exported_symbols_are_the_headers() {
    let output = Command::new("nm").args(["-D", "--defined-only"]).arg(library()).output();
    let Some(output) = output.ok().filter(|o| o.status.success()) else {
        println!("skipped: nm cannot read {}", library().display());
        return;
    };
    let exported: BTreeSet<String> = String::from_utf8(output.stdout)
        .unwrap()
        .lines()
        .filter_map(|line| line.split_whitespace().last())
        .map(str::to_string)
        .collect();
    let declared: BTreeSet<String> = functions().into_iter().map(|(name, _)| name).collect();
    assert_eq!(exported, declared);
}
