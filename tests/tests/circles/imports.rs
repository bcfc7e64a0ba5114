//! Which file of a crate imports which: paths followed through re-exports to the file that
//! defines what they name.

use crate::mentions::Mention;
use crate::modules::{Meaning, Module, Modules, Name};
use std::collections::{BTreeMap, BTreeSet};

/// What a path leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Thing {
    Module(usize),
    /// An item of a file.
    Item(usize),
}

/// What a file imports: of each other file, the names it has from there.
type Imported = BTreeMap<usize, BTreeSet<String>>;

/// The graph of a crate's files.
pub struct Imports {
    files: Vec<String>,
    of: Vec<Imported>,
}

/// Files that import each other in a circle, however long the way round.
#[derive(Debug, PartialEq, Eq)]
pub struct Circle {
    /// Sorted.
    pub files: Vec<String>,
    /// Each import among them, as `a.rs -> b.rs: names`.
    pub ties: Vec<String>,
}

impl Imports {
    /// Follows every path of a crate. A file and the one with its `mod` line are left apart, and
    /// so are re-exports: naming a module only counts by what is named within.
    pub fn of(all: &Modules) -> Self {
        let mut of = vec![Imported::new(); all.files.len()];
        for (from, module) in all.modules.iter().enumerate() {
            for mention in &module.mentions {
                for (file, name) in led_to(all, from, mention) {
                    let related = |a, b| all.families.contains(&(a, b));
                    let own = module.file;
                    if file != own && !related(file, own) && !related(own, file) {
                        of[own].entry(file).or_default().insert(name);
                    }
                }
            }
        }
        Self {
            files: all.files.clone(),
            of,
        }
    }

    /// What one file imports of another.
    pub fn between(&self, from: &str, to: &str) -> Vec<&str> {
        let place = |name: &str| self.files.iter().position(|file| file == name);
        let (from, to) = (place(from).expect("a file"), place(to).expect("a file"));
        let paths = self.of[from].get(&to).into_iter().flatten();
        paths.map(String::as_str).collect()
    }

    /// All circles, sorted by their files.
    pub fn circles(&self) -> Vec<Circle> {
        let count = self.files.len();
        let reached: Vec<BTreeSet<usize>> = (0..count).map(|file| self.reached(file)).collect();
        let mut found = Vec::new();
        for first in 0..count {
            let mutual = |other: &usize| reached[*other].contains(&first);
            let members: BTreeSet<usize> = reached[first].iter().copied().filter(mutual).collect();
            if members.len() > 1 && members.first() == Some(&first) {
                found.push(self.circle(&members));
            }
        }
        found.sort_by(|a, b| a.files.cmp(&b.files));
        found
    }

    /// The files that a file imports, directly or by others.
    fn reached(&self, from: usize) -> BTreeSet<usize> {
        let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
        while let Some(file) = open.pop() {
            open.extend(self.of[file].keys().filter(|next| seen.insert(**next)));
        }
        seen
    }

    fn circle(&self, members: &BTreeSet<usize>) -> Circle {
        let mut files: Vec<_> = members.iter().map(|f| self.files[*f].clone()).collect();
        let mut ties = Vec::new();
        for from in members {
            for (to, paths) in self.of[*from].iter().filter(|(to, _)| members.contains(to)) {
                let paths: Vec<&str> = paths.iter().map(String::as_str).collect();
                let (from, to) = (&self.files[*from], &self.files[*to]);
                ties.push(format!("{from} -> {to}: {}", paths.join(", ")));
            }
        }
        files.sort();
        ties.sort();
        Circle { files, ties }
    }
}

/// The files that define what a path leads to, with the name by which they do.
fn led_to(all: &Modules, from: usize, mention: &Mention) -> Vec<(usize, String)> {
    let path = &mention.path;
    let things = |length| resolve(all, from, &path[..length], &mut Open::new());
    let is_item = |thing: &Thing| matches!(thing, Thing::Item(_));
    let are_items = |things: BTreeSet<Thing>| !things.is_empty() && things.iter().all(is_item);
    let mut found = Vec::new();
    if !mention.glob && repeats_an_import(all, from, &path[0]) {
        return found;
    }
    for thing in things(path.len()).unwrap_or_default() {
        match thing {
            Thing::Item(file) => {
                // What follows an item within the path (a variant, a function of it) says no more.
                let names_item = |length: &usize| things(*length).is_some_and(are_items);
                let length = (1..path.len()).find(names_item);
                found.push((file, path[length.unwrap_or(path.len()) - 1].clone()));
            }
            Thing::Module(module) if mention.glob => {
                found.push((all.modules[module].file, path.join("::") + "::*"));
            }
            Thing::Module(_) => {}
        }
    }
    found
}

/// Whether a word is an item that a `use` of the module brought, which counts there already.
fn repeats_an_import(all: &Modules, from: usize, word: &str) -> bool {
    let imported = |name: &Name| !name.public && matches!(name.meaning, Meaning::Import(_));
    let names = all.modules[from].names.get(word);
    let things = || resolve(all, from, &[word.to_owned()], &mut Open::new());
    names.is_some_and(|names| names.iter().all(imported))
        && things().is_some_and(|all| all.iter().all(|t| matches!(t, Thing::Item(_))))
}

/// Names being followed, so that a name that leads to itself ends.
type Open = BTreeSet<(usize, String)>;

/// What a path leads to from a module: nothing within this crate when empty, not known here at
/// all when none.
fn resolve(
    all: &Modules,
    from: usize,
    path: &[String],
    open: &mut Open,
) -> Option<BTreeSet<Thing>> {
    let (first, mut rest) = path.split_first()?;
    let mut things = match first.as_str() {
        "crate" => BTreeSet::from([Thing::Module(all.root_of(from))]),
        "self" => BTreeSet::from([Thing::Module(from)]),
        "super" => BTreeSet::from([Thing::Module(all.modules[from].parent?)]),
        name => look_up(all, from, name, None, open)?,
    };
    while let Some((name, after)) = rest.split_first() {
        let inside = things.iter().filter_map(|thing| match thing {
            Thing::Module(module) => Some(*module),
            Thing::Item(_) => None,
        });
        let inside: Vec<usize> = inside.collect();
        if inside.is_empty() {
            // A variant, an associated item: it is where its type is.
            break;
        }
        things = BTreeSet::new();
        for module in inside {
            let found = match (name.as_str(), all.modules[module].parent) {
                ("super", Some(parent)) => Some(BTreeSet::from([Thing::Module(parent)])),
                _ => look_up(all, module, name, None, open),
            };
            // What cannot be seen is taken to be where it is looked for.
            let unseen = || BTreeSet::from([Thing::Item(all.modules[module].file)]);
            things.extend(found.unwrap_or_else(unseen));
        }
        rest = after;
    }
    Some(things)
}

/// What a name of a module stands for. By a glob import of `viewer` only names it may see count.
fn look_up(
    all: &Modules,
    within: usize,
    name: &str,
    viewer: Option<usize>,
    open: &mut Open,
) -> Option<BTreeSet<Thing>> {
    let key = (within, name.to_owned());
    if !open.insert(key.clone()) {
        // `pub use walk::walk` asks for the module of its own name.
        return named(all, within, name, viewer, None);
    }
    let found = named(all, within, name, viewer, Some(open))
        .or_else(|| globbed(all, within, name, open))
        .or_else(|| made(&all.modules[within], name));
    open.remove(&key);
    found
}

/// What a name stands for by what the module itself says; imports are followed if asked to.
fn named(
    all: &Modules,
    within: usize,
    name: &str,
    viewer: Option<usize>,
    mut open: Option<&mut Open>,
) -> Option<BTreeSet<Thing>> {
    let sees_all = viewer.is_none_or(|viewer| all.is_within(viewer, within));
    let mut found: Option<BTreeSet<Thing>> = None;
    for name in all.modules[within].names.get(name)? {
        if name.public || sees_all {
            let things = match (&name.meaning, &mut open) {
                (Meaning::Item(file), _) => BTreeSet::from([Thing::Item(*file)]),
                (Meaning::Module(module), _) => BTreeSet::from([Thing::Module(*module)]),
                (Meaning::Import(path), Some(open)) => {
                    resolve(all, within, path, open).unwrap_or_default()
                }
                (Meaning::Import(_), None) => continue,
            };
            found.get_or_insert_default().extend(things);
        }
    }
    found
}

fn globbed(all: &Modules, within: usize, name: &str, open: &mut Open) -> Option<BTreeSet<Thing>> {
    let mut found: Option<BTreeSet<Thing>> = None;
    for path in &all.modules[within].globs {
        for thing in resolve(all, within, path, open).unwrap_or_default() {
            if let Thing::Module(module) = thing
                && let Some(things) = look_up(all, module, name, Some(within), open)
            {
                found.get_or_insert_default().extend(things);
            }
        }
    }
    found
}

fn made(module: &Module, name: &str) -> Option<BTreeSet<Thing>> {
    let made = module.made.contains(name);
    made.then(|| BTreeSet::from([Thing::Item(module.file)]))
}
