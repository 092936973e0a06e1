//! The Fortran module is the header's: the committed file is what the generator makes of the committed header, it has every function and
//! constant with the right arguments, it compiles without a warning, and the generator refuses what it does not know.

use std::path::Path;
use std::process::Command;

#[path = "../fortran/generator.rs"]
mod generator;

fn read(file: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap()
}

fn made_of(header: &str) -> Result<String, String> {
    generator::module(header, &read("fortran/template.f90"))
}

#[test]
fn the_committed_module_is_the_headers() {
    let module = read("include/lapidary.f90");
    assert!(made_of(&read("include/lapidary.h")).unwrap() == module, "include/lapidary.f90 is not up to date");
    let long: Vec<&str> = module.lines().filter(|line| line.len() > 132).collect();
    assert!(long.is_empty(), "longer than a Fortran line: {long:?}");
}

/// By other means than the generator's: names of parameters and constants as plain text.
#[test]
fn nothing_is_missing() {
    let (header, module) = (read("include/lapidary.h"), read("include/lapidary.f90"));
    let mut functions = 0;
    for (start, _) in header.match_indices("\nint32_t lap_") {
        let declaration = &header[start..start + header[start..].find(';').unwrap()];
        let (name, parameters) = declaration.trim().strip_prefix("int32_t ").unwrap().split_once('(').unwrap();
        let names: Vec<&str> =
            parameters.trim_end_matches(')').split(',').map(|p| p.rsplit([' ', '*', '\n']).next().unwrap()).collect();
        let at = module.find(&format!("function {name}(")).unwrap_or_else(|| panic!("{name} is missing"));
        let end = module[at..].find(") bind(c,").unwrap() + at;
        let dummies: String = module[at..end].split_once('(').unwrap().1.replace('&', "");
        let dummies: Vec<&str> = dummies.split(',').map(str::trim).collect();
        assert_eq!(dummies, names, "{name}");
        assert!(module[end..].starts_with(&format!(") bind(c, name=\"{name}\")")), "{name}");
        assert!(module.contains(&format!("  public :: {name}\n")), "{name} is private");
        functions += 1;
    }
    assert!(functions > 40, "only {functions} functions found");
    let mut constants = 0;
    for line in header.lines().filter_map(|line| line.strip_prefix("#define LAP_")) {
        let (name, value) = line.split_once(' ').unwrap();
        let wanted = format!("  integer(c_int32_t), parameter, public :: LAP_{name} = {value}\n");
        assert!(module.contains(&wanted), "{wanted}");
        constants += 1;
    }
    assert!(constants > 20, "only {constants} constants found");
}

const FRAME: &str = "#ifndef LAPIDARY_H\n#define LAPIDARY_H\n#include <stdint.h>\n/* One. */\n#define LAP_FIRST 1\n\
                     typedef struct lap_mesh lap_mesh;\ntypedef struct lap_options { int32_t struct_size; int32_t low[3]; } lap_options;\n\
                     typedef struct lap_item { int64_t n; const double *xyz; } lap_item;\ntypedef int32_t (*lap_ask)(void *user, const int32_t *items);\n\
                     #ifdef __cplusplus\nextern \"C\" {\n#endif\n@\n#ifdef __cplusplus\n}\n#endif\n#endif\n";

#[test]
fn arguments_of_every_kind() {
    let header = FRAME.replace(
        '@',
        "/*\n A doc.\n\n Inputs: xyz: 3 × count.\n */\nint32_t lap_all(struct lap_mesh **made, const struct lap_mesh *mesh, int64_t n,\n \
         const double *xyz, const lap_options *options, const lap_item *items, lap_ask ask, double *value, const int32_t **view, const char **text, void *user);",
    );
    let module = made_of(&header).unwrap();
    for wanted in [
        "  ! One.\n  integer(c_int32_t), parameter, public :: LAP_FIRST = 1\n",
        "  type, bind(c), public :: lap_options\n    integer(c_int32_t) :: struct_size\n    integer(c_int32_t) :: low(3)\n",
        "    ! A doc.\n    !\n    ! Inputs: xyz: 3 × count.\n    integer(c_int32_t) function lap_all(made, mesh, n, ",
        "      type(c_ptr), intent(inout), optional :: made\n",
        "      type(c_ptr), value :: mesh\n",
        "      integer(c_int64_t), value :: n\n",
        "      real(c_double), intent(in), optional :: xyz(*)\n",
        "      type(lap_options), intent(in), optional :: options\n",
        "  type, bind(c), public :: lap_item\n    integer(c_int64_t) :: n\n    type(c_ptr) :: xyz\n",
        "      type(lap_item), intent(in), optional :: items(*)\n",
        "integer(c_int32_t) function lap_ask(user, items) bind(c)\n      import :: c_int32_t, c_ptr\n",
        "      type(c_funptr), value :: ask\n",
        "      real(c_double), intent(inout), optional :: value\n",
        "      type(c_ptr), intent(inout), optional :: view\n",
        "      type(c_ptr), intent(inout), optional :: text\n",
        "      type(c_ptr), value :: user\n",
    ] {
        assert!(module.contains(wanted), "{wanted:?} is not in\n{module}");
    }
}

#[test]
fn what_is_unknown_is_an_error() {
    assert!(made_of(&FRAME.replace('@', "int32_t lap_one(int32_t n);")).is_ok());
    for (unknown, what) in [
        ("int32_t lap_one(uint32_t n);", "unknown type"),
        ("int32_t lap_one(struct lap_other *other);", "unknown type"),
        ("int32_t lap_one(double **made);", "unknown type"),
        ("int32_t lap_one(void);", "unknown declaration"),
        ("int32_t lap_one(double x[3]);", "an array"),
        ("double lap_one(int32_t n);", "unknown"),
        ("int32_t lap_mesh_one(int32_t n); int32_t LAP_Mesh_One(int32_t n);", "differs from another name"),
        ("int32_t lap_options(int32_t n);", "differs from another name"),
        ("/* Outputs: x: 3 × n. */ int32_t lap_one(int64_t n, double *x);", "an array that the caller provides"),
        ("/* Outputs: x: count. */ int32_t lap_one(int64_t n, double *x);", "an array that the caller provides"),
        ("#define LAP_TWO 2.0\n", "not an int32_t"),
        ("#define LAP_TWO 4294967296\n", "not an int32_t"),
        ("#pragma pack(1)\n", "unknown"),
        ("typedef struct lap_two { double *x; } lap_two;", "unknown field"),
        ("typedef union lap_two { double x; } lap_two;", "unknown"),
        ("typedef double (*lap_two)(double x);", "unknown result"),
        ("enum lap_two { LAP_A };", "unknown"),
        ("int32_t lap_one(int32_t n)", "without end"),
    ] {
        let error = made_of(&FRAME.replace('@', unknown)).err().unwrap_or_else(|| panic!("{unknown} is taken"));
        assert!(error.contains(what), "{unknown}: {error}");
    }
}

#[test]
fn the_module_compiles() {
    let output = Command::new("gfortran")
        .args(["-std=f2018", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only"])
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("include/lapidary.f90"))
        .current_dir(env!("CARGO_TARGET_TMPDIR"))
        .output();
    match output {
        Ok(output) => assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr)),
        Err(error) => println!("skipped: gfortran does not run: {error}"),
    }
}
