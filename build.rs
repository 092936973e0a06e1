//! Generates `include/lapidary.h` from `src/capi`, the Fortran module `include/lapidary.f90` from that header, and names the
//! shared library.
//!
//! Both are committed. They are written only when their text changes, and failure to write them (a read-only checkout,
//! a vendored crate) is a warning, not an error: the committed ones are then the right ones anyway. A header that the
//! Fortran generator does not understand is an error.

#[path = "fortran/generator.rs"]
mod fortran;

use std::path::Path;

/// In the order in which the header shows them.
const SOURCES: &[&str] = &[
    "status",
    "context",
    "mesh",
    "cut",
    "complex",
    "derived",
    "keys",
    "certify",
    "grid",
    "grid_boxes",
    "grid_cells",
    "grid_moments",
    "grid_fluid",
    "simplex",
    "network",
    "network_views",
    "network_surface",
    "arrangement",
    "arrangement_views",
    "arrangement_extract",
    "surface",
    "surface_certify",
];

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=cbindgen.toml");
    let root = std::env::var("CARGO_MANIFEST_DIR").unwrap();
    let root = Path::new(&root);
    let major_minor = format!("{}.{}", env("CARGO_PKG_VERSION_MAJOR"), env("CARGO_PKG_VERSION_MINOR"));
    // What binaries record: 0 stands for every 0.x until 1.0 fixes the interface.
    let abi = env("CARGO_PKG_VERSION_MAJOR");
    match env("CARGO_CFG_TARGET_OS").as_str() {
        "linux" | "freebsd" | "android" | "netbsd" | "openbsd" => {
            println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,liblapidary.so.{abi}");
        }
        "macos" => {
            println!("cargo:rustc-cdylib-link-arg=-Wl,-install_name,@rpath/liblapidary.{abi}.dylib");
            println!("cargo:rustc-cdylib-link-arg=-Wl,-compatibility_version,{major_minor}");
        }
        _ => {}
    }
    // For tests that call the C compiler.
    println!("cargo:rustc-env=LAPIDARY_TARGET={}", env("TARGET"));
    if let Err(reason) = write_header(root) {
        println!("cargo:warning=what is in include was not brought up to date: {reason}");
    }
}

fn env(name: &str) -> String {
    std::env::var(name).unwrap_or_default()
}

fn write_header(root: &Path) -> Result<(), String> {
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml"))?;
    let mut builder = cbindgen::Builder::new().with_config(config);
    for name in SOURCES {
        let source = root.join("src/capi").join(name).with_extension("rs");
        println!("cargo:rerun-if-changed={}", source.display());
        builder = builder.with_src(source);
    }
    let mut text = Vec::new();
    builder.generate().map_err(|e| e.to_string())?.write(&mut text);
    let text = tidy(&String::from_utf8_lossy(&text));
    bring_up_to_date(&root.join("include/lapidary.h"), &text)?;
    let template = root.join("fortran/template.f90");
    println!("cargo:rerun-if-changed=fortran/generator.rs");
    println!("cargo:rerun-if-changed={}", template.display());
    let template = std::fs::read_to_string(template).map_err(|e| e.to_string())?;
    let module = fortran::module(&text, &template).unwrap_or_else(|e| panic!("the Fortran module: {e}"));
    bring_up_to_date(&root.join("include/lapidary.f90"), &module)
}

fn bring_up_to_date(file: &Path, text: &str) -> Result<(), String> {
    println!("cargo:rerun-if-changed={}", file.display());
    if std::fs::read(file).is_ok_and(|old| old == text.as_bytes()) {
        return Ok(());
    }
    let folder = file.parent().ok_or("no folder")?;
    std::fs::create_dir_all(folder).and_then(|()| std::fs::write(file, text)).map_err(|e| e.to_string())
}

/// Puts comments of one line on one line.
fn tidy(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let (mut out, mut i) = (String::with_capacity(text.len()), 0);
    while i < lines.len() {
        let indent = &lines[i][..lines[i].len() - lines[i].trim_start().len()];
        if lines[i].trim_start() == "/*" && lines.get(i + 2).is_some_and(|end| end.trim_start() == "*/") {
            out += &format!("{indent}/* {} */\n", lines[i + 1].trim_start());
            i += 3;
        } else {
            out += lines[i].trim_end();
            out.push('\n');
            i += 1;
        }
    }
    out
}
