//! The files of a crate do not import each other in a circle.
//!
//! A file imports another when one of its `use` lines, or a path in its code, leads to an item that the other defines;
//! re-exports on the way are followed. Left apart are a file and the one that has its `mod` line, `pub use` as such, and
//! all that is built for tests only. Where there is a circle, the imports that tie it are told.

use crate::tokens::{attribute, past_item};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use syn::buffer::{Cursor, TokenBuffer};
use toile_house::root;

/// A path of names, as in `crate::a::B`.
type Path = Vec<String>;
/// What a `use` leads to and the name it has here; without a name all names of a module.
type Use = (Path, Option<String>);
/// Of each file the files that it imports, with what it imports of them.
type Imports = BTreeMap<String, BTreeMap<String, BTreeSet<String>>>;

/// What a module says.
#[derive(Default)]
struct Module {
    file: String,
    /// Names of what it defines.
    items: BTreeSet<String>,
    /// Names within macros, by which these may define something.
    made: BTreeSet<String>,
    /// Names that it has by `use`, and the paths they stand for.
    names: BTreeMap<String, Path>,
    /// Modules of which it has all names.
    globs: Vec<Path>,
    /// Paths that it depends on.
    paths: Vec<Path>,
}

/// The modules of a crate by their paths.
#[derive(Default)]
struct Crate {
    modules: BTreeMap<Path, Module>,
}

type TextOf<'t> = &'t dyn Fn(&str) -> Option<String>;

impl Crate {
    /// The crate whose files a function gives by name, from its root on.
    fn read(text_of: TextOf<'_>) -> Self {
        let mut own = Self::default();
        let mut roots = ["lib.rs", "main.rs"].into_iter();
        if let Some(name) = roots.find(|name| text_of(name).is_some()) {
            own.file(name, &Path::new(), text_of);
        }
        own
    }

    fn file(&mut self, name: &str, path: &Path, text_of: TextOf<'_>) {
        let text = text_of(name).unwrap_or_default();
        let tokens = TokenBuffer::new2(syn::parse_str(&text).expect("the source is Rust"));
        let mut children = Vec::new();
        self.module(tokens.begin(), (name, path), &mut children);
        for child in children {
            let stem = child.join("/");
            let files = [format!("{stem}.rs"), format!("{stem}/mod.rs")];
            if let Some(file) = files.iter().find(|file| text_of(file).is_some()) {
                self.file(file, &child, text_of);
            }
        }
    }

    /// Reads what stands in a module; its `mod` lines are added to the children.
    fn module(
        &mut self,
        mut at: Cursor<'_>,
        (file, path): (&str, &Path),
        children: &mut Vec<Path>,
    ) {
        let mut module = Module {
            file: file.to_owned(),
            ..Module::default()
        };
        let (mut is_public, mut is_macro) = (false, false);
        while let Some((_, after)) = at.token_tree() {
            if let Some((is_test, rest)) = attribute(at) {
                at = if is_test { past_item(rest) } else { rest };
                continue;
            }
            if let Some((inside, _, _, rest)) = at.any_group() {
                // A group after `pub` says for whom.
                scan(inside, &mut module.paths);
                if is_macro {
                    capitals(inside, &mut module.made);
                }
                (is_macro, at) = (false, rest);
                continue;
            }
            is_macro |= at.punct().is_some_and(|(mark, _)| mark.as_char() == '!');
            let Some((own, rest)) = path_at(at) else {
                at = after;
                continue;
            };
            let named = rest.ident().map(|(name, after)| (name.to_string(), after));
            at = rest;
            match (own[0].as_str(), named) {
                ("pub", _) => {
                    is_public = true;
                    continue;
                }
                ("use", _) => {
                    let (found, after) = uses(rest, &[]);
                    for (target, name) in found {
                        match name {
                            Some(name) => drop(module.names.insert(name, target.clone())),
                            None => module.globs.push(target.clone()),
                        }
                        if !is_public {
                            module.paths.push(target);
                        }
                    }
                    at = after;
                }
                ("mod", Some((name, after))) => {
                    let child: Path = path.iter().cloned().chain([name.clone()]).collect();
                    module.items.insert(name);
                    at = after;
                    match after.any_group() {
                        Some((inside, _, _, after)) => {
                            self.module(inside, (file, &child), children);
                            at = after;
                        }
                        None => children.push(child),
                    }
                }
                ("macro_rules", _) => {
                    let name = rest.punct().and_then(|(_, rest)| rest.ident());
                    module.items.extend(name.map(|(name, _)| name.to_string()));
                }
                (word, Some((name, _))) if DEFINING.contains(&word) => {
                    module.items.insert(name);
                }
                _ if own.len() > 1 => module.paths.push(own),
                _ => {}
            }
            is_public = false;
        }
        self.modules.insert(path.clone(), module);
    }

    /// The file that defines what a path leads to from a module, and what that is.
    fn leads_to(&self, from: &Path, path: &[String], depth: usize) -> Option<(&str, String)> {
        let absolute = self.absolute(from, path)?;
        let known = |k: &usize| self.modules.contains_key(&absolute[..*k]);
        let (at, rest) = absolute.split_at((0..=absolute.len()).rev().find(known)?);
        let module = &self.modules[at];
        let name = rest.first()?;
        if module.items.contains(name) {
            return Some((&module.file, name.clone()));
        }
        let depth = depth.checked_sub(1)?;
        let here = at.to_vec();
        if let Some(target) = module.names.get(name) {
            let whole: Path = target.iter().chain(&rest[1..]).cloned().collect();
            return self.leads_to(&here, &whole, depth);
        }
        let of_globs = module.globs.iter().find_map(|glob| {
            let whole: Path = glob.iter().chain(rest).cloned().collect();
            self.leads_to(&here, &whole, depth)
        });
        of_globs.or_else(|| {
            module
                .made
                .contains(name)
                .then(|| (&*module.file, name.clone()))
        })
    }

    /// A path from the crate's root on; nothing where it leads out of the crate.
    fn absolute(&self, from: &Path, path: &[String]) -> Option<Path> {
        let (first, rest) = path.split_first()?;
        let mut absolute: Path = match first.as_str() {
            "crate" => Path::new(),
            "self" => from.clone(),
            "super" => from[..from.len().checked_sub(1)?].to_vec(),
            name => {
                let module = self.modules.get(from)?;
                if module.items.contains(name) {
                    return Some(from.iter().chain(path).cloned().collect());
                }
                // A name that stands for itself is that of another crate.
                let target = module.names.get(name).filter(|target| target[0] != name)?;
                let whole: Path = target.iter().chain(rest).cloned().collect();
                return self.absolute(from, &whole);
            }
        };
        for name in rest {
            match name.as_str() {
                "super" => drop(absolute.pop()),
                "self" => {}
                name => absolute.push(name.to_owned()),
            }
        }
        Some(absolute)
    }

    fn imports(&self) -> Imports {
        let mut imports = Imports::new();
        for (from, module) in &self.modules {
            let leads = module
                .paths
                .iter()
                .filter_map(|path| self.leads_to(from, path, 8));
            for (file, name) in leads {
                if file != module.file && !self.is_declared(&module.file, file) {
                    let own = imports.entry(module.file.clone()).or_default();
                    own.entry(file.to_owned()).or_default().insert(name);
                }
            }
        }
        imports
    }

    /// Whether one of two files has the `mod` line of the other.
    fn is_declared(&self, one: &str, other: &str) -> bool {
        let path_of = |file: &str| {
            let own = self
                .modules
                .iter()
                .filter(|(_, module)| module.file == file);
            own.map(|(path, _)| path).min_by_key(|path| path.len())
        };
        let (Some(a), Some(b)) = (path_of(one), path_of(other)) else {
            return false;
        };
        a.len().abs_diff(b.len()) == 1 && (a.starts_with(b) || b.starts_with(a))
    }
}

/// Words after which a module defines what is named.
const DEFINING: [&str; 8] = [
    "struct", "enum", "union", "trait", "type", "fn", "const", "static",
];

/// The path that begins here, and what comes after it.
fn path_at(at: Cursor<'_>) -> Option<(Path, Cursor<'_>)> {
    let (first, mut rest) = at.ident()?;
    let mut path = vec![first.to_string()];
    let colon = |at: Cursor<'_>| at.punct().is_some_and(|(mark, _)| mark.as_char() == ':');
    while colon(rest) {
        let second = rest
            .punct()
            .map(|(_, rest)| rest)
            .filter(|rest| colon(*rest));
        let Some((name, after)) = second.and_then(|rest| rest.punct()?.1.ident()) else {
            break;
        };
        path.push(name.to_string());
        rest = after;
    }
    Some((path, rest))
}

/// What a `use` names from here to its semicolon, and what comes after that.
fn uses<'c>(mut at: Cursor<'c>, before: &[String]) -> (Vec<Use>, Cursor<'c>) {
    let mut found = Vec::new();
    let (mut path, mut name) = (before.to_vec(), None);
    let (mut is_renamed, mut is_open) = (false, false);
    while let Some((_, after)) = at.token_tree() {
        if let Some((word, rest)) = at.ident() {
            match (word.to_string(), is_renamed) {
                (word, false) if word == "as" => is_renamed = true,
                (word, true) => name = Some(word),
                (word, false) => path.push(word),
            }
            (is_open, at) = (true, rest);
            continue;
        }
        if let Some((inside, _, _, rest)) = at.any_group() {
            found.extend(uses(inside, &path).0);
            (is_open, at) = (false, rest);
            continue;
        }
        let mark = at.punct().map(|(mark, _)| mark.as_char());
        at = after;
        match mark {
            Some('*') => {
                found.push((path.clone(), None));
                is_open = false;
            }
            Some(',' | ';') => {
                found.extend(is_open.then(|| named(path, name.take())));
                path = before.to_vec();
                (is_renamed, is_open) = (false, false);
                if mark == Some(';') {
                    return (found, at);
                }
            }
            _ => {}
        }
    }
    found.extend(is_open.then(|| named(path, name)));
    (found, at)
}

fn named(mut path: Path, name: Option<String>) -> Use {
    path.pop_if(|last| last == "self");
    let name = name.or_else(|| path.last().cloned());
    (path, name)
}

/// All names among tokens that begin with a capital.
fn capitals(mut at: Cursor<'_>, found: &mut BTreeSet<String>) {
    while let Some((_, after)) = at.token_tree() {
        if let Some((inside, ..)) = at.any_group() {
            capitals(inside, found);
        }
        let name = at.ident().map(|(name, _)| name.to_string());
        found.extend(name.filter(|name| name.starts_with(char::is_uppercase)));
        at = after;
    }
}

/// All paths of several names among tokens, and all that `use` lines among them name.
fn scan(mut at: Cursor<'_>, paths: &mut Vec<Path>) {
    // Whether what comes next goes on from something before: a field, a method, the rest of a path.
    let (mut goes_on, mut last) = (false, None);
    while let Some((_, after)) = at.token_tree() {
        if let Some((is_test, rest)) = attribute(at) {
            at = if is_test { past_item(rest) } else { rest };
        } else if let Some((inside, _, _, rest)) = at.any_group() {
            scan(inside, paths);
            (goes_on, at) = (false, rest);
        } else if let Some((path, rest)) = path_at(at) {
            at = rest;
            if path[0] == "use" && !goes_on {
                let (found, rest) = uses(rest, &[]);
                paths.extend(found.into_iter().map(|(target, _)| target));
                at = rest;
            } else if path.len() > 1 && !goes_on {
                paths.push(path);
            }
            goes_on = false;
        } else {
            let mark = at.punct().map(|(mark, _)| mark.as_char());
            goes_on = mark == Some('.') && last != mark || mark == Some(':') && last == mark;
            (last, at) = (mark, after);
            continue;
        }
        last = None;
    }
}

/// All files that can be reached from one.
fn reached<'i>(imports: &'i Imports, start: &'i str) -> BTreeSet<&'i str> {
    let mut found = BTreeSet::new();
    let mut open = vec![start];
    while let Some(file) = open.pop() {
        let next = imports.get(file).into_iter().flatten();
        let next = next.map(|(file, _)| file.as_str());
        open.extend(next.filter(|file| found.insert(*file)));
    }
    found
}

/// Circles of files that import each other, each with the imports that tie it: what can be reached from a file and leads
/// back to it (strong components).
fn circles(imports: &Imports) -> Vec<String> {
    let all: BTreeMap<&str, BTreeSet<&str>> = imports
        .keys()
        .map(|file| (&**file, reached(imports, file)))
        .collect();
    let mut told: BTreeSet<&str> = BTreeSet::new();
    let mut found = Vec::new();
    for (file, reach) in &all {
        if !reach.contains(file) || told.contains(file) {
            continue;
        }
        let back = |other: &&&str| all.get(**other).is_some_and(|reach| reach.contains(file));
        let circle: BTreeSet<&str> = reach.iter().filter(back).copied().collect();
        let mut words = format!(
            "{} import each other in a circle:",
            circle.iter().copied().collect::<Vec<_>>().join(", ")
        );
        for from in &circle {
            for (to, names) in imports[*from]
                .iter()
                .filter(|(to, _)| circle.contains(to.as_str()))
            {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                words += &format!("\n  {from} imports {} of {to}", names.join(", "));
            }
        }
        told.extend(circle);
        found.push(words);
    }
    found
}

#[test]
fn files_of_a_crate_do_not_import_each_other_in_a_circle() {
    let crates = fs::read_dir(root().join("crates")).expect("readable");
    let mut folders: Vec<_> = crates
        .flatten()
        .map(|entry| entry.path().join("src"))
        .collect();
    folders.push(root().join("ui/src"));
    folders.retain(|folder| folder.is_dir());
    assert!(folders.len() >= 15, "only {} crates found", folders.len());
    let complaints = folders.iter().flat_map(|folder| {
        let own = Crate::read(&|name| fs::read_to_string(folder.join(name)).ok());
        assert!(!own.modules.is_empty(), "no crate in {}", folder.display());
        let found = circles(&own.imports()).into_iter();
        found.map(|words| format!("{}: {words}", folder.display()))
    });
    let complaints: Vec<String> = complaints.collect();
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n\n"));
}

/// What `a.rs` imports of `b.rs`, when this is its text.
fn of_b(text: &str) -> Vec<String> {
    let files = [
        (
            "lib.rs",
            "mod a; mod b; pub use b::Shown; pub mod prelude { pub use crate::b::*; }",
        ),
        ("a.rs", text),
        (
            "b.rs",
            "pub mod c; pub struct Plain<T>(T); pub struct Shown; pub fn f<T>() {} pub enum Kind { Left } \
             #[cfg(test)] pub struct ForTests;",
        ),
        ("b/c.rs", "pub struct Deep;"),
    ];
    let text_of = |name: &str| {
        files
            .iter()
            .find(|file| file.0 == name)
            .map(|file| file.1.to_owned())
    };
    let imports = Crate::read(&text_of).imports();
    let names = imports.get("a.rs").and_then(|own| own.get("b.rs"));
    names.into_iter().flatten().cloned().collect()
}

#[test]
fn imports_are_followed_however_they_are_written() {
    for (text, names) in [
        (
            "use crate::{b::{self, c::{Deep as Near}, Plain}};",
            &["Plain"][..],
        ),
        (
            "use crate::b as other; fn g() { other::f::<u8>(); }",
            &["f"],
        ),
        (
            "use crate::b::{self as other}; type T = other::Shown;",
            &["Shown"],
        ),
        ("use crate::b; mod inner { use super::b::Kind; }", &["Kind"]),
        ("use crate::Shown;", &["Shown"]),
        ("use crate::prelude::Plain;", &["Plain"]),
        (
            "fn g() { use super::b::f; let k = crate::b::Kind::Left; }",
            &["Kind", "f"],
        ),
        (
            "fn g() -> X { X { k: crate::b::Kind::Left, ..super::b::f() } }",
            &["Kind", "f"],
        ),
        (
            "fn g() { println!(\"{:?}\", super::b::Kind::Left) }",
            &["Kind"],
        ),
        // Naming a module alone, re-exports, tests and other crates import nothing.
        ("use crate::b;", &[]),
        (
            "pub use crate::b::Plain; pub(crate) use super::b::Kind;",
            &[],
        ),
        (
            "#[cfg(test)] mod tests { use crate::b::Plain; } #[cfg(test)] use crate::b::f;",
            &[],
        ),
        ("use b::Plain; fn g() { x.crate_::b(); std::b::f(); }", &[]),
    ] {
        assert_eq!(of_b(text), names, "{text}");
    }
}

#[test]
fn a_circle_is_told_with_what_ties_it() {
    let files = [
        ("lib.rs", "mod a; mod b; mod c; mod d;"),
        ("a.rs", "use crate::b::B; pub struct A; pub struct X;"),
        ("b.rs", "use crate::c::C; pub struct B;"),
        (
            "c.rs",
            "fn c() -> crate::a::A {} pub struct C; use crate::d::D;",
        ),
        // Beside the circle, and a parent with its child.
        ("d.rs", "pub mod e; use e::E; pub struct D;"),
        ("d/e.rs", "use super::D; use crate::a::X; pub struct E;"),
    ];
    let text_of = |name: &str| {
        files
            .iter()
            .find(|file| file.0 == name)
            .map(|file| file.1.to_owned())
    };
    let found = circles(&Crate::read(&text_of).imports());
    assert_eq!(
        found,
        [
            "a.rs, b.rs, c.rs import each other in a circle:\n  a.rs imports B of b.rs\n  b.rs imports C of c.rs\n  c.rs imports A of a.rs"
        ]
    );
    let open = ["use crate::b::B; pub struct A;", "pub struct B;"];
    let text_of = |name: &str| match name {
        "lib.rs" => Some("mod a; mod b;".to_owned()),
        "a.rs" => Some(open[0].to_owned()),
        "b.rs" => Some(open[1].to_owned()),
        _ => None,
    };
    assert!(circles(&Crate::read(&text_of).imports()).is_empty());
}
