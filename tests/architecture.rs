//! The rules that the sources keep: the order of the stages, citations, sizes, dependencies with reasons, and no
//! function whose last bit differs between machines.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Each stage uses itself and those before it.
const STAGES: [&str; 16] = [
    "geometry",
    "sampling",
    "spectrum",
    "sequence",
    "mesh",
    "accel",
    "optics",
    "light",
    "scene",
    "integrator",
    "film",
    "driver",
    "movie",
    "study",
    "capi",
    "cli",
];

/// One concept a file.
const LONGEST_FILE: usize = 500;

/// `mod.rs` holds types and dispatch over them; what is longer is an algorithm.
const LONGEST_IN_MOD: usize = 30;

#[test]
fn no_stage_uses_a_later_one() {
    fail_with(sources("src").iter().flat_map(|(path, text)| match stage_of(path) {
        Some(stage) => named(path, later_stages(stage, text)),
        None => Vec::new(),
    }));
}

#[test]
fn every_folder_is_a_stage_and_every_stage_a_folder() {
    let folders: BTreeSet<String> = fs::read_dir(root().join("src"))
        .unwrap()
        .map(|entry| entry.unwrap())
        .filter(|entry| entry.path().is_dir())
        .map(|entry| entry.file_name().into_string().unwrap())
        .collect();
    assert_eq!(folders, STAGES.iter().map(ToString::to_string).collect());
}

#[test]
fn every_citation_is_in_the_bibliography_and_every_entry_is_cited() {
    let entries = bibliography(&fs::read_to_string(root().join("src/references.md")).unwrap());
    assert!(entries.len() > 20, "the bibliography was not understood: {entries:?}");
    let cited: BTreeSet<String> = sources("src").iter().flat_map(|(_, text)| citations(text)).collect();
    let unknown: Vec<_> = cited.difference(&entries).collect();
    let unused: Vec<_> = entries.difference(&cited).collect();
    assert!(unknown.is_empty(), "cited, but not in src/references.md: {unknown:?}");
    assert!(unused.is_empty(), "in src/references.md, but never cited: {unused:?}");
}

#[test]
fn entries_of_the_bibliography_are_sorted_and_stand_once() {
    let text = fs::read_to_string(root().join("src/references.md")).unwrap();
    let keys: Vec<&str> = text.lines().filter_map(entry_key).collect();
    let mut sorted = keys.clone();
    sorted.sort_unstable();
    sorted.dedup();
    assert_eq!(keys, sorted);
    assert_eq!(text.lines().filter(|line| line.starts_with('#')).count(), 1, "one heading");
}

#[test]
fn files_are_short_and_say_what_they_are() {
    let all = sources("src").into_iter().chain(sources("tests"));
    fail_with(all.flat_map(|(path, text)| {
        let lines = text.lines().count();
        let long = (lines > LONGEST_FILE).then(|| format!("{lines} lines, at most {LONGEST_FILE}"));
        // The unit tests of a file, put into a file of their own, are described by it.
        let described = text.starts_with("//!") || path.ends_with("tests.rs");
        let mute = (!described).then(|| "does not begin with its documentation".to_owned());
        named(&path, long.into_iter().chain(mute).collect())
    }));
}

#[test]
fn nothing_is_left_to_be_done() {
    fail_with(sources("src").iter().flat_map(|(path, text)| named(path, unfinished(text))));
}

#[test]
fn mod_files_hold_no_algorithms() {
    let modules = sources("src").into_iter().filter(|(path, _)| path.ends_with("mod.rs"));
    fail_with(modules.flat_map(|(path, text)| named(&path, long_functions(&text))));
}

#[test]
fn elementary_functions_have_the_same_bits_everywhere() {
    let all = sources("src");
    let tests: Vec<PathBuf> = all.iter().flat_map(|(path, text)| test_modules(path, text)).collect();
    let used =
        all.iter().filter(|(path, _)| !path.ends_with("geometry/elementary.rs") && !tests.contains(path));
    fail_with(used.flat_map(|(path, text)| named(path, platform_functions(text))));
}

#[test]
fn every_dependency_has_its_reason() {
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let (without_reason, count) = dependencies_without_reason(&manifest);
    assert!(count > 10, "the manifest was not understood");
    assert!(without_reason.is_empty(), "no comment above {without_reason:?} in Cargo.toml");
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The Rust sources below a folder of the package, by their paths in it.
fn sources(folder: &str) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    let mut folders = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                // What a package inside has compiled is not ours.
                folders.extend((!path.ends_with("target")).then_some(path));
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                found.push((path.strip_prefix(root()).unwrap().to_owned(), text));
            }
        }
    }
    found.sort();
    found
}

fn stage_of(path: &Path) -> Option<usize> {
    let name = path.components().nth(1)?.as_os_str().to_str()?;
    STAGES.iter().position(|stage| *stage == name)
}

fn named(path: &Path, problems: Vec<String>) -> Vec<String> {
    problems.into_iter().map(|problem| format!("{}: {problem}", path.display())).collect()
}

fn fail_with(problems: impl Iterator<Item = String>) {
    let problems: Vec<String> = problems.collect();
    assert!(problems.is_empty(), "\n{}", problems.join("\n"));
}

/// The lines that are code, with their numbers; comments are cut off.
fn code(text: &str) -> impl Iterator<Item = (usize, &str)> {
    (1..).zip(text.lines()).map(|(number, line)| {
        let end = line.match_indices("//").find(|(at, _)| !line[..*at].ends_with(':')).map(|(at, _)| at);
        (number, &line[..end.unwrap_or(line.len())])
    })
}

/// Paths from the crate's root in a line, such as `mesh` of `crate::mesh::read`; `{` of a group of several.
fn paths_from_root(line: &str) -> impl Iterator<Item = &str> {
    ["crate::", "super::super::"].into_iter().flat_map(move |root| {
        line.match_indices(root).map(move |(at, _)| {
            let path = &line[at + root.len()..];
            let end = path.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(path.len());
            // From two levels up a group is mostly one of the stage itself.
            &path[..end.max(usize::from(root == "crate::" && path.starts_with('{')))]
        })
    })
}

fn later_stages(stage: usize, text: &str) -> Vec<String> {
    let mut problems = Vec::new();
    for (number, line) in code(text) {
        for name in paths_from_root(line) {
            if name == "{" {
                problems.push(format!("line {number}: write one `use` for each stage"));
            }
            if STAGES.iter().position(|other| *other == name).is_some_and(|other| other > stage) {
                problems.push(format!("line {number}: {} uses {name}, a later stage", STAGES[stage]));
            }
        }
    }
    problems
}

/// The key of a line of the bibliography: ``* `[KEY]` ...``.
fn entry_key(line: &str) -> Option<&str> {
    line.strip_prefix("* `[")?.split_once("]`").map(|(key, _)| key)
}

fn bibliography(text: &str) -> BTreeSet<String> {
    text.lines().filter_map(entry_key).map(str::to_owned).collect()
}

/// Keys in `` `[KEY eq. n]` ``: capitals and digits, at least two. In the lines of an equation, where nothing is
/// quoted, a key is known by the year that it ends with.
fn citations(text: &str) -> Vec<String> {
    let comments = text.lines().filter(|line| line.trim_start().starts_with("//"));
    let mut keys = Vec::new();
    for line in comments {
        for (at, _) in line.match_indices('[') {
            let rest = &line[at + 1..];
            let end =
                rest.find(|c: char| !c.is_ascii_uppercase() && !c.is_ascii_digit()).unwrap_or(rest.len());
            let key = &rest[..end];
            let closed = rest[end..].starts_with([' ', ']', ',']);
            let year = key.len() > 3 && key.ends_with(|c: char| c.is_ascii_digit());
            let is_key = key.starts_with(|c: char| c.is_ascii_uppercase()) && key.len() > 1;
            if is_key && closed && (line[..at].ends_with('`') || year) {
                keys.push(key.to_owned());
            }
        }
    }
    keys
}

fn unfinished(text: &str) -> Vec<String> {
    let marks = ["todo!", "unimplemented!", "TODO", "FIXME", "XXX", "dbg!("];
    let lines = (1..).zip(text.lines());
    lines
        .flat_map(|(number, line)| {
            marks
                .iter()
                .filter(|mark| line.contains(**mark))
                .map(move |mark| format!("line {number}: {mark}"))
        })
        .collect()
}

/// Functions of formatted code that are longer than [`LONGEST_IN_MOD`], tests aside.
fn long_functions(text: &str) -> Vec<String> {
    let mut open: Option<(usize, usize, &str)> = None;
    let mut problems = Vec::new();
    for (number, line) in code(before_tests(text)) {
        let indent = line.len() - line.trim_start().len();
        let is_head = line.split_whitespace().take_while(|w| !w.starts_with('"')).any(|w| w == "fn");
        if open.is_none() && is_head && !line.trim_end().ends_with(';') {
            open = Some((number, indent, line));
        }
        if let Some((start, depth, head)) = open
            && indent == depth
            && line.trim_end().ends_with('}')
        {
            let lines = number - start + 1;
            if lines > LONGEST_IN_MOD {
                problems.push(format!("line {start}: {lines} lines in `{}`", head.trim()));
            }
            open = None;
        }
    }
    problems
}

/// Calls of the platform's mathematics, whose last bit is not the same everywhere; tests may use them.
fn platform_functions(text: &str) -> Vec<String> {
    const NAMES: [&str; 22] = [
        "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp",
        "exp2", "exp_m1", "ln", "ln_1p", "log", "log2", "log10", "powf", "cbrt", "mul_add",
    ];
    let called = |line: &str, name: &str| {
        [format!(".{name}("), format!("f32::{name}("), format!("f64::{name}(")]
            .iter()
            .any(|c| line.contains(c))
    };
    code(before_tests(text))
        .flat_map(|(number, line)| {
            NAMES
                .iter()
                .filter(move |name| called(line, name))
                .map(move |name| format!("line {number}: {name}; use crate::geometry::elementary or libm"))
        })
        .collect()
}

/// The files of the modules that a file declares for tests only.
fn test_modules(path: &Path, text: &str) -> Vec<PathBuf> {
    let declared = text.split("#[cfg(test)]\nmod ").skip(1).filter_map(|rest| {
        let (name, _) = rest.split_once(';')?;
        name.chars().all(|c| c.is_alphanumeric() || c == '_').then_some(name)
    });
    let folder =
        if path.ends_with("mod.rs") { path.parent().unwrap().to_owned() } else { path.with_extension("") };
    declared.map(|name| folder.join(name).with_extension("rs")).collect()
}

fn before_tests(text: &str) -> &str {
    text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text)
}

/// Dependencies without a comment above them, and how many dependencies there are.
fn dependencies_without_reason(manifest: &str) -> (Vec<String>, usize) {
    let mut without = Vec::new();
    let mut count = 0;
    let (mut inside, mut reason) = (false, false);
    for line in manifest.lines() {
        if line.starts_with('[') {
            inside = line.ends_with("dependencies]");
        } else if inside && line.contains('=') {
            count += 1;
            if !reason {
                without.push(line.split('=').next().unwrap_or(line).trim().to_owned());
            }
        }
        reason = line.starts_with("# ") && line.len() > 10;
    }
    (without, count)
}

/// The rules can fail: each finds what is planted.
mod planted {
    use super::*;

    #[test]
    fn a_later_stage_is_found_however_it_is_named() {
        let mesh = STAGES.iter().position(|s| *s == "mesh").unwrap();
        for (text, problems) in [
            ("use crate::accel::Accel;", 1),
            ("    let x = crate::driver::render(1);", 1),
            ("use super::super::scene::Frame;", 1),
            ("use crate::{geometry, scene};", 1),
            ("use crate::geometry::Ray;\nuse crate::sequence::FrameNumber;\nuse crate::mesh::read;", 0),
            ("/// See [`crate::scene::Frame`].\n// crate::film", 0),
            ("let url = \"https://crate::film\";", 1),
            ("use crate::filming::x;", 0),
        ] {
            assert_eq!(later_stages(mesh, text).len(), problems, "{text}");
        }
        assert_eq!(stage_of(Path::new("src/mesh/ply/mod.rs")), Some(mesh));
        assert_eq!(stage_of(Path::new("src/lib.rs")), None);
    }

    #[test]
    fn citations_and_entries_are_found() {
        let text = "//! From `[WOOP13 sec. 3]` and `[OPENEXR]`; `[f32; 3]`, `[A]`, `[0, 1]`, `[NOT_A_KEY]`, [RGB] are none.\n\
                    //! x = y    [QUAN95]\nlet a = \"`[JOE08]`\";";
        assert_eq!(citations(text), ["WOOP13", "OPENEXR", "QUAN95"]);
        let entries = bibliography("# References\n* `[WOOP13]` S. Woop.\nnot `[X12]` here\n");
        assert_eq!(entries.into_iter().collect::<Vec<_>>(), ["WOOP13"]);
    }

    #[test]
    fn unfinished_code_is_found() {
        assert_eq!(unfinished("fn a() { todo!() }\n// FIXME: b\nfn c() {}").len(), 2);
    }

    #[test]
    fn algorithms_in_mod_files_are_found() {
        let function = |lines: usize| {
            format!("impl A {{\n    pub fn a() {{\n{}    }}\n}}\n", "        b();\n".repeat(lines))
        };
        assert!(long_functions(&function(LONGEST_IN_MOD - 2)).is_empty());
        assert_eq!(long_functions(&function(LONGEST_IN_MOD - 1)).len(), 1);
    }

    #[test]
    fn functions_of_the_platform_are_found() {
        for bad in ["let a = x.sin();", "a.mul_add(b, c)", "f64::exp(x)"] {
            assert_eq!(platform_functions(bad).len(), 1, "{bad}");
        }
        for good in [
            "libm::sin(x)",
            "elementary::exp(x)",
            "x.sqrt()",
            "// x.sin()",
            "#[cfg(test)]\nmod tests {\nx.sin()",
        ] {
            assert!(platform_functions(good).is_empty(), "{good}");
        }
    }

    #[test]
    fn modules_for_tests_are_told_apart() {
        let text = "#[cfg(test)]\nmod splitmix;\nmod exr;\n#[cfg(test)]\nmod tests {\n}\n";
        assert_eq!(test_modules(Path::new("src/film/mod.rs"), text), [Path::new("src/film/splitmix.rs")]);
        let text = "#[cfg(test)]\nmod tests;\n";
        assert_eq!(test_modules(Path::new("src/a/b.rs"), text), [Path::new("src/a/b/tests.rs")]);
    }

    #[test]
    fn a_dependency_without_a_reason_is_found() {
        let manifest = "[package]\nname = \"a\"\n[dependencies]\n# Because of this.\nb = \"1\"\nc = \"1\"\n[dev-dependencies]\nd = \"2\"\n";
        assert_eq!(dependencies_without_reason(manifest), (vec!["c".to_owned(), "d".to_owned()], 3));
    }
}
