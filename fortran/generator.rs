//! Makes the Fortran module `lapidary` out of the C header and `template.f90`.
//!
//! The header is read strictly: constants, opaque structs, option structs, structs that come in arrays, callback types and functions in the very
//! forms that it uses. Whatever else appears is an error, so the module cannot silently lack something. Also errors: names that differ
//! in case alone (to Fortran they are the same), names too long, and an output that looks like an array filled by the caller (all
//! outputs are single values or views so far; assumed-size would be needed).

use std::collections::BTreeSet;

/// Longest line of code or comment; Fortran's limit is 132.
const WIDTH: usize = 120;

/// `const base **name[array]`
struct Declaration<'a> {
    base: &'a str,
    constant: bool,
    stars: usize,
    name: &'a str,
    array: Option<usize>,
}

/// What is collected of the module.
#[derive(Default)]
struct Module<'a> {
    text: String,
    /// Public names in lower case.
    names: BTreeSet<String>,
    opaque: BTreeSet<&'a str>,
    options: BTreeSet<&'a str>,
    elements: BTreeSet<&'a str>,
    callbacks: BTreeSet<&'a str>,
}

/// The text of the module.
pub fn module(header: &str, template: &str) -> Result<String, String> {
    let mut module = Module::default();
    for own in ["lap_view", "lap_text"] {
        module.names.insert(own.into());
    }
    let (mut doc, mut rest) = ("", header.trim_start());
    let (mut host_only, mut functions) = (false, false);
    while !rest.is_empty() {
        if let Some(comment) = rest.strip_prefix("/*") {
            let end = comment.find("*/").ok_or("a comment without end")?;
            doc = &comment[..end];
            rest = comment[end + 2..].trim_start();
            continue;
        }
        if rest.starts_with('#') {
            let (line, next) = rest.split_once('\n').unwrap_or((rest, ""));
            rest = next.trim_start();
            match line.split_once("//").map_or(line, |l| l.0).split("/*").next().unwrap_or("").trim() {
                "#ifndef LAPIDARY_H" | "#define LAPIDARY_H" | "#include <stdint.h>" => {}
                "#ifdef __cplusplus" => host_only = true,
                "#endif" => host_only = false,
                line => module.constant(line.strip_prefix("#define ").ok_or(format!("unknown: {line}"))?, doc)?,
            }
            continue;
        }
        if host_only {
            let (_, next) = rest.split_once('\n').unwrap_or(("", ""));
            rest = next.trim_start();
            continue;
        }
        let end = item_end(rest)?;
        let (item, next) = (&rest[..end], rest[end + 1..].trim_start());
        if item.starts_with("int32_t ") {
            functions = true;
            module.function(item, doc)?;
        } else if functions {
            return Err(format!("a declaration after the first function: {item}"));
        } else {
            module.type_definition(item, doc)?;
        }
        (doc, rest) = ("", next);
    }
    let parts: Vec<&str> = template.split("! @GENERATED@\n").flat_map(|part| part.split("! @VIEWS@\n")).collect();
    let [head, helpers, tail] = parts[..] else { return Err("the template lacks its two marks".into()) };
    Ok(format!("{head}{}{helpers}{}{tail}", module.text, views()))
}

/// Where the declaration that `text` starts with has its semicolon: outside of braces and comments.
fn item_end(text: &str) -> Result<usize, String> {
    let (mut depth, mut i) = (0, 0);
    let bytes = text.as_bytes();
    while i < bytes.len() {
        match bytes[i] {
            b'/' if bytes.get(i + 1) == Some(&b'*') => {
                i += text[i..].find("*/").ok_or("a comment without end")? + 1;
            }
            b'{' => depth += 1,
            b'}' => depth -= 1,
            b';' if depth == 0 => return Ok(i),
            _ => {}
        }
        i += 1;
    }
    Err(format!("a declaration without end: {}", text.lines().next().unwrap_or("")))
}

fn declaration(text: &str) -> Result<Declaration<'_>, String> {
    let unknown = || format!("unknown declaration: {text}");
    let text = text.trim();
    let (text, array) = match text.strip_suffix(']') {
        None => (text, None),
        Some(text) => {
            let (text, count) = text.split_once('[').ok_or_else(unknown)?;
            (text, Some(count.parse().map_err(|_| unknown())?))
        }
    };
    let name = text.rsplit([' ', '*']).next().unwrap_or("");
    let mut rest = text[..text.len() - name.len()].trim();
    let stars = rest.chars().rev().take_while(|&c| c == '*').count();
    rest = rest[..rest.len() - stars].trim();
    let constant = rest.starts_with("const ");
    rest = rest.strip_prefix("const ").unwrap_or(rest);
    let base = rest.strip_prefix("struct ").unwrap_or(rest);
    let word = |s: &str| !s.is_empty() && s.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if !word(name) || !word(base) || array.is_some() && stars > 0 {
        return Err(unknown());
    }
    Ok(Declaration { base, constant, stars, name, array })
}

/// The Fortran type of a number, and its kind.
fn number(base: &str) -> Option<(&'static str, &'static str)> {
    match base {
        "int32_t" => Some(("integer(c_int32_t)", "c_int32_t")),
        "int64_t" => Some(("integer(c_int64_t)", "c_int64_t")),
        "uint8_t" => Some(("integer(c_int8_t)", "c_int8_t")),
        "double" => Some(("real(c_double)", "c_double")),
        _ => None,
    }
}

impl<'a> Module<'a> {
    fn name(&mut self, name: &str) -> Result<(), String> {
        if name.len() > 63 {
            return Err(format!("{name} is too long for Fortran"));
        }
        if !self.names.insert(name.to_lowercase()) {
            return Err(format!("{name} differs from another name in case alone, or is there twice"));
        }
        Ok(())
    }

    fn constant(&mut self, text: &str, doc: &str) -> Result<(), String> {
        let parts: Vec<&str> = text.split_whitespace().collect();
        let [name, value] = parts[..] else { return Err(format!("unknown: #define {text}")) };
        let value: i32 = value.parse().map_err(|_| format!("{name} is not an int32_t: {value}"))?;
        self.name(name)?;
        self.text += &comment(doc, "  ");
        self.text += &format!("  integer(c_int32_t), parameter, public :: {name} = {value}\n");
        Ok(())
    }

    fn type_definition(&mut self, item: &'a str, doc: &str) -> Result<(), String> {
        let unknown = || format!("unknown: {item}");
        let text = item.strip_prefix("typedef ").ok_or_else(unknown)?;
        if let Some((result, signature)) = text.split_once("(*") {
            let (name, parameters) = signature.split_once(")(").ok_or_else(unknown)?;
            return self.callback(result.trim(), name, parameters.strip_suffix(')').ok_or_else(unknown)?, doc);
        }
        let text = text.strip_prefix("struct ").ok_or_else(unknown)?;
        let Some((name, fields)) = text.split_once('{') else {
            let (tag, name) = text.split_once(' ').ok_or_else(unknown)?;
            if tag != name {
                return Err(unknown());
            }
            self.opaque.insert(name);
            self.text += &comment(&format!("Handle {name} (type(c_ptr)).\n{}", plain(doc)), "  ");
            return Ok(());
        };
        let (name, (fields, after)) = (name.trim(), fields.rsplit_once('}').ok_or_else(unknown)?);
        if after.trim() != name {
            return Err(unknown());
        }
        self.name(name)?;
        // Options tell their size; other structs come in arrays.
        if fields.contains(" struct_size;") {
            self.options.insert(name)
        } else {
            self.elements.insert(name)
        };
        self.text += &format!("\n{}  type, bind(c), public :: {name}\n", comment(doc, "  "));
        let mut rest = fields.trim();
        while !rest.is_empty() {
            if let Some(inner) = rest.strip_prefix("/*") {
                let (doc, next) = inner.split_once("*/").ok_or_else(unknown)?;
                self.text += &comment(doc, "    ");
                rest = next.trim_start();
                continue;
            }
            let (field, next) = rest.split_once(';').ok_or_else(unknown)?;
            let d = declaration(field)?;
            let kind = match (d.stars, number(d.base)) {
                (0, Some((kind, _))) => kind,
                // An array of the caller's.
                (1, Some(_)) if d.constant => "type(c_ptr)",
                _ => return Err(format!("{name}: unknown field {field}")),
            };
            let shape = d.array.map_or(String::new(), |n| format!("({n})"));
            self.text += &format!("    {kind} :: {}{shape}\n", d.name);
            rest = next.trim_start();
        }
        self.text += "  end type\n";
        Ok(())
    }

    /// Parameters of a callback come by value: numbers and addresses.
    fn callback(&mut self, result: &str, name: &'a str, parameters: &str, doc: &str) -> Result<(), String> {
        self.name(name)?;
        self.callbacks.insert(name);
        let kind = match result {
            "void" => "subroutine",
            "int32_t" => "function",
            _ => return Err(format!("{name}: unknown result {result}")),
        };
        let (mut names, mut lines) = (Vec::new(), Vec::new());
        let mut imports = BTreeSet::new();
        for parameter in parameters.split(',') {
            let d = declaration(parameter)?;
            let (of_type, import) = match (d.stars, number(d.base)) {
                (0, Some(found)) => found,
                (1, None) if matches!(d.base, "void" | "char") => ("type(c_ptr)", "c_ptr"),
                (1, Some(_)) if d.constant => ("type(c_ptr)", "c_ptr"),
                _ => return Err(format!("{name}: unknown parameter {parameter}")),
            };
            imports.insert(import);
            names.push(d.name);
            lines.push(format!("      {of_type}, value :: {}\n", d.name));
        }
        if kind == "function" {
            imports.insert("c_int32_t");
        }
        let typed = if kind == "function" { "integer(c_int32_t) function" } else { kind };
        let imports: Vec<&str> = imports.into_iter().collect();
        self.text += &format!(
            "\n  public :: {name}\n  abstract interface\n{}    {typed} {name}({}) bind(c)\n      import :: {}\n{}    end {kind}\n  end interface\n",
            comment(doc, "    "),
            names.join(", "),
            imports.join(", "),
            lines.concat()
        );
        Ok(())
    }

    fn function(&mut self, item: &str, doc: &str) -> Result<(), String> {
        let unknown = || format!("unknown: {item}");
        let (name, parameters) =
            item.strip_prefix("int32_t ").and_then(|text| text.split_once('(')).ok_or_else(unknown)?;
        let parameters = parameters.strip_suffix(')').ok_or_else(unknown)?;
        self.name(name)?;
        let (mut names, mut lines) = (Vec::new(), Vec::new());
        let mut imports = BTreeSet::from(["c_int32_t"]);
        for parameter in parameters.split(',') {
            let d = declaration(parameter)?;
            let (line, import) = self.parameter(&d, doc).map_err(|e| format!("{name}: {parameter}: {e}"))?;
            imports.insert(import);
            names.push(d.name);
            lines.push(format!("      {line}\n"));
        }
        let imports: Vec<&str> = imports.into_iter().collect();
        self.text += &format!(
            "\n  public :: {name}\n  interface\n{}{}\n      import :: {}\n{}    end function\n  end interface\n",
            comment(doc, "    "),
            head(name, &names),
            imports.join(", "),
            lines.concat()
        );
        Ok(())
    }

    /// The declaration of a dummy argument, and what it imports.
    fn parameter<'d>(&self, d: &Declaration<'d>, doc: &str) -> Result<(String, &'d str), String> {
        let name = d.name;
        let address = |what: &str| Ok((format!("type(c_ptr), {what} :: {name}"), "c_ptr"));
        if d.array.is_some() {
            return Err("an array".into());
        }
        match (d.stars, number(d.base)) {
            (0, Some((of_type, import))) => Ok((format!("{of_type}, value :: {name}"), import)),
            (0, None) if self.callbacks.contains(d.base) => {
                Ok((format!("type(c_funptr), value :: {name}"), "c_funptr"))
            }
            (1, Some((of_type, import))) if d.constant => {
                Ok((format!("{of_type}, intent(in), optional :: {name}(*)"), import))
            }
            (1, Some((of_type, import))) => {
                // "name: 3 × count" and its like is how the manual describes arrays.
                let described = doc.split(&format!("{name}: ")).nth(1).unwrap_or("");
                if described.starts_with(|c: char| c.is_ascii_digit()) || described.starts_with("count") {
                    return Err("an array that the caller provides?".into());
                }
                Ok((format!("{of_type}, intent(inout), optional :: {name}"), import))
            }
            (1, None) if d.base == "char" && d.constant => {
                Ok((format!("character(kind=c_char), intent(in), optional :: {name}(*)"), "c_char"))
            }
            (1, None) if d.base == "void" || self.opaque.contains(d.base) => address("value"),
            (1, None) if self.elements.contains(d.base) && d.constant => {
                Ok((format!("type({}), intent(in), optional :: {name}(*)", d.base), d.base))
            }
            (1, None) if self.options.contains(d.base) => {
                let intent = if d.constant { "in" } else { "inout" };
                Ok((format!("type({}), intent({intent}), optional :: {name}", d.base), d.base))
            }
            // Views, strings and handles that are handed out.
            (2, Some(_)) if d.constant => address("intent(inout), optional"),
            (2, None) if d.base == "char" && d.constant || self.opaque.contains(d.base) => {
                address("intent(inout), optional")
            }
            _ => Err("unknown type".into()),
        }
    }
}

/// The lines of a C comment without its indentation.
fn plain(doc: &str) -> String {
    doc.trim().lines().map(str::trim).collect::<Vec<_>>().join("\n")
}

/// A C comment as Fortran's, paragraphs filled anew.
fn comment(doc: &str, indent: &str) -> String {
    let mut out = String::new();
    let text = plain(doc);
    for (i, paragraph) in text.split("\n\n").enumerate() {
        if i > 0 {
            out += &format!("{indent}!\n");
        }
        let mut current = format!("{indent}!");
        for word in paragraph.split_whitespace() {
            // Bytes, as compilers count.
            if current.len() + 1 + word.len() > WIDTH {
                out += &current;
                out.push('\n');
                current = format!("{indent}!");
            }
            current.push(' ');
            current += word;
        }
        out += &current;
        out.push('\n');
    }
    out
}

/// The first statement of a function, continued on further lines where it is too long.
fn head(name: &str, dummies: &[&str]) -> String {
    let mut out = format!("    integer(c_int32_t) function {name}(");
    let mut length = out.len();
    for (i, dummy) in dummies.iter().enumerate() {
        let end = if i + 1 < dummies.len() { ", ".into() } else { format!(") bind(c, name=\"{name}\")") };
        if length + dummy.len() + end.len() + 1 > WIDTH {
            out += "&\n      ";
            length = 6;
        }
        out += dummy;
        out += &end;
        length += dummy.len() + end.len();
    }
    out
}

/// The specific procedures of `lap_view`.
fn views() -> String {
    let mut out = String::new();
    for (base, name) in [("uint8_t", "int8"), ("int32_t", "int32"), ("int64_t", "int64"), ("double", "double")] {
        let (of_type, _) = number(base).expect("a number");
        out += &format!(
            "
  subroutine view_{name}(address, count, view)
    type(c_ptr), intent(in) :: address
    integer(c_int64_t), intent(in) :: count
    {of_type}, pointer, intent(out) :: view(:)
    view => no_{name}
    if (c_associated(address) .and. count > 0) call c_f_pointer(address, view, [count])
  end subroutine
"
        );
        if base == "uint8_t" {
            continue;
        }
        out += &format!(
            "
  subroutine columns_{name}(address, rows, count, view)
    type(c_ptr), intent(in) :: address
    integer, intent(in) :: rows
    integer(c_int64_t), intent(in) :: count
    {of_type}, pointer, intent(out) :: view(:, :)
    view(1:rows, 1:0) => no_{name}
    if (c_associated(address) .and. count > 0) call c_f_pointer(address, view, [int(rows, c_int64_t), count])
  end subroutine
"
        );
    }
    out
}
