//! The modules of one crate as they stand in its files: what each defines, imports and names.

use crate::mentions::{
    Import, Mention, Reader, attributes, is_for_tests, item_words, path_attribute,
};
use std::collections::{BTreeMap, BTreeSet};
use syn::{Attribute, Item, Visibility};

/// What a name of a module stands for.
#[derive(Debug)]
pub enum Meaning {
    /// An item that this file defines.
    Item(usize),
    /// A child.
    Module(usize),
    /// Whatever a path leads to.
    Import(Vec<String>),
}

/// A name of a module.
#[derive(Debug)]
pub struct Name {
    pub meaning: Meaning,
    /// Whether it has any `pub`, so that a glob import elsewhere may bring it.
    pub public: bool,
}

/// A module, in a file of its own or within one.
#[derive(Debug, Default)]
pub struct Module {
    pub parent: Option<usize>,
    /// Its file's place in [`Modules::files`].
    pub file: usize,
    /// By name; one name may be a module and a function at once.
    pub names: BTreeMap<String, Vec<Name>>,
    /// Modules or enumerations all of whose names are imported.
    pub globs: Vec<Vec<String>>,
    /// Words of macros among its items: what those define cannot be seen, but has such a name.
    pub made: BTreeSet<String>,
    /// Paths in its code that may lead to other files.
    pub mentions: Vec<Mention>,
}

/// The modules of a crate but for those of its tests.
#[derive(Debug, Default)]
pub struct Modules {
    /// Names of the files from the crate's source folder.
    pub files: Vec<String>,
    pub modules: Vec<Module>,
    /// Files with the file that has their `mod` line.
    pub families: BTreeSet<(usize, usize)>,
}

/// Where a module's text is.
#[derive(Clone)]
struct Place {
    file: usize,
    /// The folder with the files of its children.
    folder: String,
}

/// Gives the text of a file by its name from the source folder.
type Files<'a> = &'a dyn Fn(&str) -> Option<String>;

impl Modules {
    /// Reads the library and the program of a crate, each with all the files it is made of.
    pub fn read(files: Files<'_>) -> Self {
        let mut all = Self::default();
        for root in ["lib.rs", "main.rs"] {
            if let Some(text) = files(root) {
                all.add_file(files, root, &text, None, String::new());
            }
        }
        all
    }

    /// The module at the crate's root.
    pub fn root_of(&self, mut module: usize) -> usize {
        while let Some(parent) = self.modules[module].parent {
            module = parent;
        }
        module
    }

    /// Whether a module is another or lies anywhere within it.
    pub fn is_within(&self, module: usize, outer: usize) -> bool {
        let mut at = Some(module);
        while let Some(module) = at {
            if module == outer {
                return true;
            }
            at = self.modules[module].parent;
        }
        false
    }

    /// Adds the module of a file; nothing when the whole file is for tests.
    fn add_file(
        &mut self,
        files: Files<'_>,
        name: &str,
        text: &str,
        parent: Option<usize>,
        folder: String,
    ) -> Option<usize> {
        let parsed = syn::parse_file(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        if is_for_tests(&parsed.attrs) {
            return None;
        }
        let known = self.files.iter().position(|file| file == name);
        let file = known.unwrap_or_else(|| {
            self.files.push(name.to_owned());
            self.files.len() - 1
        });
        if let Some(parent) = parent {
            self.families.insert((file, self.modules[parent].file));
        }
        let place = Place { file, folder };
        Some(self.add_module(files, &place, &parsed.items, parent))
    }

    fn add_module(
        &mut self,
        files: Files<'_>,
        place: &Place,
        items: &[Item],
        parent: Option<usize>,
    ) -> usize {
        let module = self.modules.len();
        self.modules.push(Module {
            parent,
            file: place.file,
            ..Module::default()
        });
        let mut reader = Reader::default();
        for item in items.iter().filter(|item| !is_for_tests(attributes(item))) {
            if let Item::Mod(child) = item {
                let name = child.ident.to_string();
                let inside = match &child.content {
                    Some((_, items)) => {
                        let place = Place {
                            folder: joined(&place.folder, &name),
                            ..place.clone()
                        };
                        Some(self.add_module(files, &place, items, Some(module)))
                    }
                    None => self.add_child(files, place, &name, &child.attrs, module),
                };
                if let Some(inside) = inside {
                    self.add_name(module, name, Meaning::Module(inside), &child.vis);
                }
                continue;
            }
            self.add_item(module, item);
            reader.read(item);
        }
        for import in reader.imports {
            self.add_import(module, import);
        }
        self.modules[module].mentions = reader.mentions;
        module
    }

    /// Adds the file that a `mod` line speaks of.
    fn add_child(
        &mut self,
        files: Files<'_>,
        place: &Place,
        name: &str,
        attributes: &[Attribute],
        parent: usize,
    ) -> Option<usize> {
        let own = joined(&place.folder, name);
        let (path, folder) = match path_attribute(attributes) {
            Some(path) => {
                let beside = joined(folder_of(&self.files[place.file]), &path);
                let folder = folder_of(&beside).to_owned();
                (beside, folder)
            }
            None => {
                let nested = joined(&own, "mod.rs");
                let plain = format!("{own}.rs");
                let path = if files(&plain).is_some() {
                    plain
                } else {
                    nested
                };
                (path, own)
            }
        };
        let text = files(&path).unwrap_or_else(|| panic!("{path} of `mod {name};` is missing"));
        self.add_file(files, &path, &text, Some(parent), folder)
    }

    /// Adds what an item other than a module defines.
    fn add_item(&mut self, module: usize, item: &Item) {
        let file = self.modules[module].file;
        let (name, public) = match item {
            Item::Const(item) => (&item.ident, &item.vis),
            Item::Enum(item) => (&item.ident, &item.vis),
            Item::Fn(item) => (&item.sig.ident, &item.vis),
            Item::Static(item) => (&item.ident, &item.vis),
            Item::Struct(item) => (&item.ident, &item.vis),
            Item::Trait(item) => (&item.ident, &item.vis),
            Item::TraitAlias(item) => (&item.ident, &item.vis),
            Item::Type(item) => (&item.ident, &item.vis),
            Item::Union(item) => (&item.ident, &item.vis),
            Item::Macro(item) => {
                self.modules[module].made.extend(item_words(item));
                let Some(name) = &item.ident else { return };
                let exported = item.attrs.iter().any(|a| a.path().is_ident("macro_export"));
                let home = if exported {
                    self.root_of(module)
                } else {
                    module
                };
                let public = exported;
                let meaning = Meaning::Item(file);
                let names = self.modules[home].names.entry(name.to_string());
                names.or_default().push(Name { meaning, public });
                return;
            }
            _ => return,
        };
        self.add_name(module, name.to_string(), Meaning::Item(file), public);
    }

    fn add_name(&mut self, module: usize, name: String, meaning: Meaning, seen: &Visibility) {
        let public = !matches!(seen, Visibility::Inherited);
        let names = self.modules[module].names.entry(name);
        names.or_default().push(Name { meaning, public });
    }

    fn add_import(&mut self, module: usize, import: Import) {
        let module = &mut self.modules[module];
        match import.name {
            Some(name) => module.names.entry(name).or_default().push(Name {
                meaning: Meaning::Import(import.path),
                public: import.public,
            }),
            None => module.globs.push(import.path),
        }
    }
}

fn folder_of(file: &str) -> &str {
    file.rfind('/').map_or("", |end| &file[..end])
}

/// A path within a folder, with steps upwards taken.
fn joined(folder: &str, path: &str) -> String {
    let mut steps: Vec<&str> = folder.split('/').filter(|step| !step.is_empty()).collect();
    for step in path.split('/') {
        match step {
            "." => {}
            ".." if steps.last().is_some_and(|last| *last != "..") => {
                steps.pop();
            }
            step => steps.push(step),
        }
    }
    steps.join("/")
}
