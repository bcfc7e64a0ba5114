//! What code imports and names: every `use`, and every path in bodies, types and macros.

use syn::buffer::{Cursor, TokenBuffer};
use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};
use syn::{
    Arm, Attribute, Expr, ExprCall, Field, FieldValue, ImplItem, Item, ItemMacro, ItemUse, Lit,
    Local, Macro, Meta, Path, Stmt, Token, TraitItem, UseTree, Variant, Visibility,
};

/// One name brought by a `use`.
#[derive(Debug)]
pub struct Import {
    pub path: Vec<String>,
    /// The name it has here; none when all names are imported.
    pub name: Option<String>,
    /// Whether it is a re-export.
    pub public: bool,
}

/// A path that code depends on, when it leads to an item of the same crate.
#[derive(Debug)]
pub struct Mention {
    pub path: Vec<String>,
    /// Whether it is the path of a glob import: this depends on the module itself.
    pub glob: bool,
}

/// Reads items of one module.
#[derive(Default)]
pub struct Reader {
    pub imports: Vec<Import>,
    pub mentions: Vec<Mention>,
}

impl Reader {
    /// Reads an item and all within it but for tests.
    pub fn read(&mut self, item: &Item) {
        self.visit_item(item);
    }

    fn mention(&mut self, path: Vec<String>) {
        self.mentions.push(Mention { path, glob: false });
    }

    /// Adds the names of a `use`, braces opened.
    fn import(&mut self, mut before: Vec<String>, tree: &UseTree, public: bool) {
        let name = match tree {
            UseTree::Path(step) => {
                before.push(step.ident.to_string());
                return self.import(before, &step.tree, public);
            }
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.import(before.clone(), tree, public);
                }
                return;
            }
            UseTree::Glob(_) => None,
            UseTree::Name(end) => Some((end.ident.to_string(), None)),
            UseTree::Rename(end) => Some((end.ident.to_string(), Some(end.rename.to_string()))),
        };
        let glob = name.is_none();
        let name = name.map(|(end, renamed)| {
            if end != "self" {
                before.push(end);
            }
            renamed
                .or_else(|| before.last().cloned())
                .unwrap_or_default()
        });
        if !public {
            let path = before.clone();
            self.mentions.push(Mention { path, glob });
        }
        self.imports.push(Import {
            path: before,
            name,
            public,
        });
    }

    /// Finds the paths among the tokens of a macro or an attribute, which have no other form.
    fn read_tokens(&mut self, mut at: Cursor<'_>) {
        // Whether what comes next goes on from something before: a field, a method, the rest of
        // a path that began with a type in angle brackets, a variable of a macro.
        let (mut goes_on, mut last) = (false, ' ');
        while !at.eof() {
            if let Some((inside, _, _, after)) = at.any_group() {
                self.read_tokens(inside);
                (goes_on, last, at) = (false, ' ', after);
            } else if let Some((first, mut after)) = at.ident() {
                let mut path = vec![first.to_string()];
                while let Some((next, rest)) = past_colons(after).and_then(Cursor::ident) {
                    path.push(next.to_string());
                    after = rest;
                }
                let whole = !goes_on || (last == '$' && path[0] == "crate");
                if whole && (path.len() > 1 || is_type_like(&path[0])) {
                    self.mention(path);
                }
                (goes_on, last, at) = (false, ' ', after);
            } else if let Some((mark, after)) = at.punct() {
                let mark = mark.as_char();
                goes_on = match mark {
                    '.' => last != '.',
                    ':' => last == ':',
                    mark => mark == '$',
                };
                (last, at) = (mark, after);
            } else if let Some((_, after)) = at.token_tree() {
                (goes_on, last, at) = (false, ' ', after);
            } else {
                return;
            }
        }
    }
}

/// What follows two colons.
fn past_colons(at: Cursor<'_>) -> Option<Cursor<'_>> {
    let (first, at) = at.punct()?;
    let (second, at) = at.punct()?;
    (first.as_char() == ':' && second.as_char() == ':').then_some(at)
}

/// Whether a lone word is a type, trait or constant, and so no variable.
fn is_type_like(word: &str) -> bool {
    word.starts_with(|first: char| first.is_uppercase())
}

fn words_of(path: &Path) -> Vec<String> {
    let words = path.segments.iter().map(|step| step.ident.to_string());
    words.collect()
}

impl<'ast> Visit<'ast> for Reader {
    fn visit_item(&mut self, item: &'ast Item) {
        if !is_for_tests(attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        let attributes = match item {
            ImplItem::Const(item) => &item.attrs,
            ImplItem::Fn(item) => &item.attrs,
            ImplItem::Type(item) => &item.attrs,
            ImplItem::Macro(item) => &item.attrs,
            _ => return,
        };
        if !is_for_tests(attributes) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_trait_item(&mut self, item: &'ast TraitItem) {
        let attributes = match item {
            TraitItem::Const(item) => &item.attrs,
            TraitItem::Fn(item) => &item.attrs,
            TraitItem::Type(item) => &item.attrs,
            TraitItem::Macro(item) => &item.attrs,
            _ => return,
        };
        if !is_for_tests(attributes) {
            visit::visit_trait_item(self, item);
        }
    }

    fn visit_field(&mut self, field: &'ast Field) {
        if !is_for_tests(&field.attrs) {
            visit::visit_field(self, field);
        }
    }

    fn visit_variant(&mut self, variant: &'ast Variant) {
        if !is_for_tests(&variant.attrs) {
            visit::visit_variant(self, variant);
        }
    }

    fn visit_field_value(&mut self, value: &'ast FieldValue) {
        if !is_for_tests(&value.attrs) {
            visit::visit_field_value(self, value);
        }
    }

    fn visit_arm(&mut self, arm: &'ast Arm) {
        if !is_for_tests(&arm.attrs) {
            visit::visit_arm(self, arm);
        }
    }

    fn visit_local(&mut self, local: &'ast Local) {
        if !is_for_tests(&local.attrs) {
            visit::visit_local(self, local);
        }
    }

    fn visit_stmt(&mut self, statement: &'ast Stmt) {
        let attributes: &[Attribute] = match statement {
            Stmt::Macro(statement) => &statement.attrs,
            Stmt::Expr(Expr::Assign(expression), _) => &expression.attrs,
            Stmt::Expr(Expr::Block(expression), _) => &expression.attrs,
            Stmt::Expr(Expr::Call(expression), _) => &expression.attrs,
            Stmt::Expr(Expr::ForLoop(expression), _) => &expression.attrs,
            Stmt::Expr(Expr::If(expression), _) => &expression.attrs,
            Stmt::Expr(Expr::Macro(expression), _) => &expression.attrs,
            Stmt::Expr(Expr::MethodCall(expression), _) => &expression.attrs,
            _ => &[],
        };
        if !is_for_tests(attributes) {
            visit::visit_stmt(self, statement);
        }
    }

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        if item.leading_colon.is_none() {
            let public = !matches!(item.vis, Visibility::Inherited);
            self.import(Vec::new(), &item.tree, public);
        }
    }

    fn visit_path(&mut self, path: &'ast Path) {
        let words = words_of(path);
        if path.leading_colon.is_none() && (words.len() > 1 || is_type_like(&words[0])) {
            self.mention(words);
        }
        visit::visit_path(self, path);
    }

    fn visit_expr_call(&mut self, call: &'ast ExprCall) {
        if let Expr::Path(called) = &*call.func {
            let words = words_of(&called.path);
            if words.len() == 1 && called.qself.is_none() {
                self.mention(words);
            }
        }
        visit::visit_expr_call(self, call);
    }

    fn visit_macro(&mut self, made: &'ast Macro) {
        if made.path.leading_colon.is_none() {
            self.mention(words_of(&made.path));
        }
        self.read_tokens(TokenBuffer::new2(made.tokens.clone()).begin());
    }

    fn visit_attribute(&mut self, attribute: &'ast Attribute) {
        match &attribute.meta {
            Meta::List(list) => self.read_tokens(TokenBuffer::new2(list.tokens.clone()).begin()),
            Meta::Path(path) => self.visit_path(path),
            Meta::NameValue(_) => {}
        }
    }
}

/// The attributes of an item.
pub fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::ExternCrate(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::ForeignMod(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::TraitAlias(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// Whether something is built for tests only.
pub fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || attribute.path().is_ident("cfg")
                && attribute.parse_args().is_ok_and(|on| needs_tests(&on))
    })
}

/// Whether a condition never holds outside tests.
fn needs_tests(condition: &Meta) -> bool {
    let Meta::List(list) = condition else {
        return condition.path().is_ident("test");
    };
    let parts = list.parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated);
    let parts = parts.unwrap_or_default();
    if list.path.is_ident("all") {
        parts.iter().any(needs_tests)
    } else {
        list.path.is_ident("any") && !parts.is_empty() && parts.iter().all(needs_tests)
    }
}

/// The file named by `#[path = ".."]`.
pub fn path_attribute(attributes: &[Attribute]) -> Option<String> {
    attributes
        .iter()
        .find_map(|attribute| match &attribute.meta {
            Meta::NameValue(pair) if pair.path.is_ident("path") => match &pair.value {
                Expr::Lit(value) => match &value.lit {
                    Lit::Str(text) => Some(text.value()),
                    _ => None,
                },
                _ => None,
            },
            _ => None,
        })
}

/// Names that a macro among items may define: all words given to one that is called, and the
/// words behind `struct`, `fn` and the like in one that is defined.
pub fn item_words(item: &ItemMacro) -> Vec<String> {
    const DEFINING: [&str; 8] = [
        "struct", "enum", "union", "trait", "fn", "const", "static", "type",
    ];
    let buffer = TokenBuffer::new2(item.mac.tokens.clone());
    let (mut found, mut open) = (Vec::new(), vec![buffer.begin()]);
    while let Some(mut at) = open.pop() {
        let mut defines = item.ident.is_none();
        while !at.eof() {
            if let Some((inside, _, _, after)) = at.any_group() {
                open.push(inside);
                at = after;
            } else if let Some((word, after)) = at.ident() {
                let word = word.to_string();
                let keyword = DEFINING.contains(&word.as_str());
                if defines && !keyword {
                    found.push(word);
                }
                defines = keyword || item.ident.is_none();
                at = after;
            } else if let Some((_, after)) = at.token_tree() {
                defines = item.ident.is_none();
                at = after;
            } else {
                break;
            }
        }
    }
    found
}
