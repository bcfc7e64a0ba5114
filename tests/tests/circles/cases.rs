//! The graph and the verdict on small sources.

use crate::imports::{Circle, Imports};
use crate::known::Known;
use crate::modules::Modules;
use crate::verdict::complaints;
use std::collections::BTreeMap;

fn imports(files: &[(&str, &str)]) -> Imports {
    let text = |name: &str| files.iter().find(|file| file.0 == name);
    Imports::of(&Modules::read(&|name| Some(text(name)?.1.to_owned())))
}

/// What `a.rs` imports of `b.rs`, which has some items and a child, when this is its text.
fn of_b(text: &str) -> Vec<String> {
    let graph = imports(&[
        ("lib.rs", "mod a; mod b; pub use b::Shown;"),
        ("a.rs", text),
        (
            "b.rs",
            "pub mod c; pub struct Plain<T>(T); pub struct Shown; pub fn f<T>() {} \
             pub const SIZE: usize = 1; pub enum Kind { Left, Right(u8) } pub trait Does {}",
        ),
        ("b/c.rs", "pub struct Deep;"),
    ]);
    let names = graph.between("a.rs", "b.rs");
    names.into_iter().map(str::to_owned).collect()
}

#[test]
fn every_name_within_nested_braces_is_followed() {
    let graph = imports(&[
        ("lib.rs", "mod a; mod b;"),
        (
            "a.rs",
            "use crate::{b::{self, c::{Deep, d::{Far as Near}}, Plain}};",
        ),
        ("b.rs", "pub mod c; pub struct Plain;"),
        ("b/c.rs", "pub mod d; pub struct Deep;"),
        ("b/c/d.rs", "pub struct Far;"),
    ]);
    assert_eq!(graph.between("a.rs", "b.rs"), ["Plain"]);
    assert_eq!(graph.between("a.rs", "b/c.rs"), ["Deep"]);
    assert_eq!(graph.between("a.rs", "b/c/d.rs"), ["Far"]);
}

#[test]
fn a_renamed_module_is_followed() {
    assert_eq!(
        of_b("use crate::b as other; fn g() { other::f::<u8>(); }"),
        ["f"]
    );
    assert_eq!(
        of_b("use crate::b::{self as other}; type T = other::Shown;"),
        ["Shown"]
    );
}

#[test]
fn naming_a_module_alone_imports_nothing_of_it() {
    assert!(of_b("use crate::b; use crate::b::c; type T = (c::Deep, b::c::Deep);").is_empty());
    assert!(of_b("use super::b::{self, c::Deep};").is_empty());
}

#[test]
fn a_glob_import_counts_for_the_module_and_for_what_it_re_exports() {
    let graph = imports(&[
        ("lib.rs", "mod a; mod b; mod c;"),
        (
            "a.rs",
            "use crate::b::*; fn g(_: Moved) { Moved::new(); moved(); hidden(); }",
        ),
        (
            "b.rs",
            "pub use crate::c::{Moved, moved}; use crate::c::hidden;",
        ),
        (
            "c.rs",
            "pub struct Moved; pub fn moved() {} pub fn hidden() {}",
        ),
    ]);
    assert_eq!(graph.between("a.rs", "b.rs"), ["crate::b::*"]);
    assert_eq!(graph.between("a.rs", "c.rs"), ["Moved", "moved"]);
    assert_eq!(
        of_b("fn g() { use crate::b::Kind::*; let _ = Left; }"),
        ["Kind"]
    );
}

#[test]
fn re_exports_are_followed_through_two_files_to_the_one_that_defines() {
    let graph = imports(&[
        (
            "lib.rs",
            "mod a; mod b; mod c; mod d; pub use b::Last as Best;",
        ),
        ("a.rs", "use crate::Best; fn g() { crate::b::Last::new(); }"),
        ("b.rs", "pub(crate) use super::c::Middle as Last;"),
        ("c.rs", "pub use crate::d::*;"),
        ("d.rs", "pub struct Middle;"),
    ]);
    assert_eq!(graph.between("a.rs", "d.rs"), ["Best", "Last"]);
    for passed in ["lib.rs", "b.rs", "c.rs"] {
        assert!(graph.between("a.rs", passed).is_empty(), "{passed}");
    }
    // Nor do those who pass it on import anything.
    assert!(graph.between("b.rs", "d.rs").is_empty());
    assert!(graph.between("c.rs", "d.rs").is_empty());
}

#[test]
fn a_re_exported_name_counts_where_it_is_used() {
    assert!(of_b("pub use crate::b::Shown;").is_empty());
    assert_eq!(
        of_b("pub use crate::b::Shown; pub struct Has(Shown);"),
        ["Shown"]
    );
}

#[test]
fn a_private_import_above_serves_those_within() {
    let graph = imports(&[
        ("lib.rs", "mod a; mod d;"),
        ("a.rs", "mod b; use crate::d::Far;"),
        ("a/b.rs", "use super::Far;"),
        ("d.rs", "pub struct Far;"),
    ]);
    assert_eq!(graph.between("a/b.rs", "d.rs"), ["Far"]);
}

#[test]
fn super_climbs_as_often_as_it_is_said() {
    let graph = imports(&[
        ("lib.rs", "mod a; mod d;"),
        ("a/mod.rs", "mod b;"),
        (
            "a/b.rs",
            "use super::super::d::Far; mod inner { use super::super::super::d::near; }",
        ),
        ("d.rs", "pub struct Far; pub fn near() {}"),
    ]);
    assert_eq!(graph.between("a/b.rs", "d.rs"), ["Far", "near"]);
}

#[test]
fn paths_in_code_and_types_count() {
    assert_eq!(of_b("fn g() -> usize { crate::b::SIZE }"), ["SIZE"]);
    assert_eq!(
        of_b("fn g(_: &super::b::Plain<crate::Shown>) {}"),
        ["Plain", "Shown"]
    );
    assert_eq!(of_b("fn g<T: crate::b::Does>() {}"), ["Does"]);
    assert_eq!(of_b("impl crate::b::Does for u8 {}"), ["Does"]);
    assert_eq!(
        of_b("fn g() { let _ = <u8 as crate::b::Does>::done; }"),
        ["Does"]
    );
    assert_eq!(
        of_b("fn g(k: u8) { if let crate::b::Kind::Left = k {} }"),
        ["Kind"]
    );
    assert_eq!(of_b("fn g() { use crate::b::f; f::<u8>() }"), ["f"]);
    assert_eq!(
        of_b("use crate::b::Kind; fn g() { Kind::Right(1); }"),
        ["Kind"]
    );
}

#[test]
fn generics_are_no_part_of_a_path_but_hold_others() {
    assert_eq!(
        of_b("fn g() { crate::b::f::<crate::b::Kind>(); }"),
        ["Kind", "f"]
    );
    assert_eq!(of_b("fn g() { crate::b::Plain::<u8>::new(); }"), ["Plain"]);
}

#[test]
fn what_is_for_tests_is_left_out() {
    for text in [
        "#[cfg(test)] mod tests { use crate::b::f; }",
        "#[cfg(test)] use crate::b::f;",
        "#[cfg(test)] fn g() { crate::b::f::<u8>() }",
        "#[cfg(all(unix, test))] fn g() { crate::b::f::<u8>() }",
        "#[test] fn g() { crate::b::f::<u8>() }",
        "impl G { #[cfg(test)] fn g() { crate::b::f::<u8>() } }",
        "struct G { #[cfg(test)] g: crate::b::Shown }",
        "fn g() { #[cfg(test)] crate::b::f::<u8>(); }",
        "fn g() { #[cfg(test)] let _ = crate::b::f::<u8>(); }",
    ] {
        assert!(of_b(text).is_empty(), "{text}");
    }
    for text in [
        "#[cfg(not(test))] use crate::b::f;",
        "#[cfg(any(test, unix))] use crate::b::f;",
    ] {
        assert_eq!(of_b(text), ["f"], "{text}");
    }
}

#[test]
fn files_for_tests_are_not_read() {
    let graph = imports(&[
        ("lib.rs", "mod a; mod b; mod c; #[cfg(test)] mod absent;"),
        ("a.rs", "#[cfg(test)] mod tests; pub struct Here;"),
        ("a/tests.rs", "use crate::b::There;"),
        ("b.rs", "use crate::a::Here; pub struct There;"),
        ("c.rs", "#![cfg(test)] mod absent; use crate::b::There;"),
    ]);
    assert!(graph.circles().is_empty());
    assert_eq!(graph.between("b.rs", "a.rs"), ["Here"]);
}

#[test]
fn comments_and_strings_are_no_code() {
    assert!(
        of_b(
            r##"
            // use crate::b::f;
            /* use crate::b::f; /* nested */ crate::b::f() */
            //! [`crate::b::f`]
            /// See [`crate::b::Shown`].
            fn g() -> [&'static str; 3] {
                [r#"use crate::b::f; " crate::b::SIZE"#, "crate::b::f // \" use crate::b::f;", "x"]
            }
            fn h() { println!("use crate::b::f; {}", r"crate::b::SIZE"); }
            "##
            .replace("//! ", "// ")
            .as_str()
        )
        .is_empty()
    );
}

#[test]
fn a_string_with_slashes_hides_no_code() {
    assert_eq!(
        of_b(r#"fn g() { h("https://x"); crate::b::f::<u8>() }"#),
        ["f"]
    );
}

#[test]
fn a_file_and_the_one_directly_above_are_left_apart() {
    let graph = imports(&[
        ("lib.rs", "mod a; pub struct Top;"),
        (
            "a/mod.rs",
            "mod b; pub struct Above; use b::Below; use crate::Top;",
        ),
        (
            "a/b/mod.rs",
            "mod c; pub struct Below; use super::Above; use crate::Top;",
        ),
        ("a/b/c.rs", "use super::super::Above; use super::Below;"),
    ]);
    assert!(graph.between("a/mod.rs", "a/b/mod.rs").is_empty());
    assert!(graph.between("a/b/mod.rs", "a/mod.rs").is_empty());
    assert!(graph.between("a/mod.rs", "lib.rs").is_empty());
    // But not what is further above.
    assert_eq!(graph.between("a/b/mod.rs", "lib.rs"), ["Top"]);
    assert_eq!(graph.between("a/b/c.rs", "a/mod.rs"), ["Above"]);
}

#[test]
fn a_name_of_a_child_leads_into_it() {
    let graph = imports(&[
        ("lib.rs", "mod a;"),
        ("a.rs", "mod b; fn g() { b::c::deep(); }"),
        ("a/b.rs", "pub mod c;"),
        ("a/b/c.rs", "pub fn deep() {}"),
    ]);
    assert_eq!(graph.between("a.rs", "a/b/c.rs"), ["deep"]);
}

#[test]
fn a_path_attribute_says_where_a_child_is() {
    let graph = imports(&[
        ("lib.rs", "mod a; mod d;"),
        ("a/mod.rs", r#"#[path = "../odd/place.rs"] mod b;"#),
        ("odd/place.rs", "use super::super::d::Far;"),
        ("d.rs", "pub struct Far;"),
    ]);
    assert_eq!(graph.between("odd/place.rs", "d.rs"), ["Far"]);
}

#[test]
fn modules_within_a_file_belong_to_it() {
    let graph = imports(&[
        ("lib.rs", "mod a; mod d;"),
        (
            "a.rs",
            "mod inner { pub struct In; mod file; use super::super::d::Far; }",
        ),
        ("a/inner/file.rs", ""),
        ("d.rs", "use crate::a::inner::In; pub struct Far;"),
    ]);
    assert_eq!(graph.between("d.rs", "a.rs"), ["In"]);
    assert_eq!(graph.between("a.rs", "d.rs"), ["Far"]);
}

#[test]
fn paths_within_macros_count() {
    for text in [
        "fn g() { vec![crate::b::f::<u8>()]; }",
        "fn g() { assert!(x.y(super::b::f::<u8>(1)), \"{}\", 2); }",
        "fn g() { let _ = vec![0..crate::b::f::<u8>()]; }",
        "use super::b; fn g() { assert_eq!(b::f::<u8>(), ()); }",
        "macro_rules! m { ($x:ident) => { $crate::b::f::<u8>($x::f()) }; }",
        "#[cfg_attr(unix, some(crate::b::f))] fn g() {}",
    ] {
        assert_eq!(of_b(text), ["f"], "{text}");
    }
    assert_eq!(
        of_b("fn g() { matches!(k, crate::b::Kind::Right(_)); }"),
        ["Kind"]
    );
    assert_eq!(
        of_b("fn g() { vec![<u8 as crate::b::Does>::b::f]; }"),
        ["Does"]
    );
    assert!(of_b("use super::b; fn g() { vec![self.b::f, x.b::f::<u8>()]; }").is_empty());
}

#[test]
fn macros_are_followed_to_where_they_are_defined() {
    let graph = imports(&[
        ("lib.rs", "mod a; mod b; mod c;"),
        ("a.rs", "fn g() { crate::shout!(); crate::b::whisper!(); }"),
        (
            "b.rs",
            "macro_rules! whisper { () => {} } pub(crate) use whisper;",
        ),
        ("c.rs", "#[macro_export] macro_rules! shout { () => {} }"),
    ]);
    assert_eq!(graph.between("a.rs", "b.rs"), ["whisper"]);
    assert_eq!(graph.between("a.rs", "c.rs"), ["shout"]);
}

#[test]
fn what_macros_define_is_found_by_its_name() {
    let graph = imports(&[
        ("lib.rs", "mod d; mod a; mod b; mod c; pub use d::*;"),
        (
            "a.rs",
            "use crate::d::{Any, First}; type T = crate::d::Nowhere;",
        ),
        (
            "b.rs",
            "macro_rules! ids { ($name:ident) => { pub struct $name; pub enum Any {} }; } \
             ids!(First);",
        ),
        ("c.rs", "pub struct Other;"),
        ("d.rs", "pub use crate::b::*; pub use crate::c::*;"),
    ]);
    assert_eq!(graph.between("a.rs", "b.rs"), ["Any", "First"]);
    assert!(graph.between("a.rs", "c.rs").is_empty());
    // What is not found counts where it is looked for.
    assert_eq!(graph.between("a.rs", "d.rs"), ["Nowhere"]);
}

#[test]
fn one_name_may_be_a_module_and_a_function() {
    let graph = imports(&[
        ("lib.rs", "mod a; mod walk; pub use walk::walk;"),
        ("a.rs", "use crate::walk; use crate::walk::Step;"),
        (
            "walk/mod.rs",
            "mod along; pub use along::walk; pub struct Step;",
        ),
        ("walk/along.rs", "pub fn walk() {}"),
    ]);
    assert_eq!(graph.between("a.rs", "walk/along.rs"), ["walk"]);
    assert_eq!(graph.between("a.rs", "walk/mod.rs"), ["Step"]);
}

#[test]
fn names_of_other_crates_lead_nowhere() {
    let graph = imports(&[
        (
            "lib.rs",
            "mod a; pub use std::fmt; pub use std::vec::Vec as List;",
        ),
        (
            "a.rs",
            "use crate::{List, fmt::Display}; use ::std::mem; use std::a::b; use std::*;",
        ),
    ]);
    assert!(graph.between("a.rs", "lib.rs").is_empty());
}

/// A crate with files that import each other as told.
fn crate_of(edges: &[(&str, &str)]) -> Vec<Circle> {
    let mut files = BTreeMap::new();
    for (from, to) in edges {
        files.entry(*to).or_insert_with(String::new);
        let text: &mut String = files.entry(*from).or_default();
        *text += &format!("use crate::{to}::Item{to};");
    }
    let root: String = files.keys().map(|name| format!("mod {name};")).collect();
    let mut texts = vec![("lib.rs".to_owned(), root)];
    for (name, uses) in files {
        texts.push((
            format!("{name}.rs"),
            format!("{uses} pub struct Item{name};"),
        ));
    }
    let text = |name: &str| texts.iter().find(|file| file.0 == name);
    Imports::of(&Modules::read(&|name| Some(text(name)?.1.clone()))).circles()
}

#[test]
fn circles_of_any_length_are_told_apart() {
    assert!(crate_of(&[("a", "b"), ("b", "c"), ("a", "c"), ("d", "c")]).is_empty());
    let edges = [
        ("a", "b"),
        ("b", "a"),
        ("b", "c"),
        ("c", "d"),
        ("d", "e"),
        ("e", "c"),
        ("f", "a"),
    ];
    let found = crate_of(&edges);
    assert_eq!(found.len(), 2);
    assert_eq!(found[0].files, ["a.rs", "b.rs"]);
    assert_eq!(
        found[0].ties,
        ["a.rs -> b.rs: Itemb", "b.rs -> a.rs: Itema"]
    );
    assert_eq!(found[1].files, ["c.rs", "d.rs", "e.rs"]);
}

/// What is said of a crate when these circles are known.
fn said(edges: &[(&str, &str)], known: &'static [&'static [&'static str]]) -> Vec<String> {
    let known: [Known; 1] = [("x/src", known)];
    complaints(&BTreeMap::from([("x/src", crate_of(edges))]), &known)
}

const TWO: &[(&str, &str)] = &[("a", "b"), ("b", "a")];
const THREE: &[(&str, &str)] = &[("a", "b"), ("b", "c"), ("c", "a")];

#[test]
fn known_circles_pass() {
    assert!(said(TWO, &[&["a.rs", "b.rs"]]).is_empty());
    assert!(said(THREE, &[&["a.rs", "b.rs", "c.rs"]]).is_empty());
    assert!(said(&[("a", "b")], &[]).is_empty());
}

#[test]
fn a_new_circle_is_told_with_its_ties() {
    let said = said(TWO, &[]);
    assert_eq!(said.len(), 1);
    assert!(said[0].starts_with("x/src: these files import each other in a circle: a.rs, b.rs."));
    assert!(said[0].contains("a.rs -> b.rs: Itemb"));
}

#[test]
fn a_circle_that_grew_is_told_by_what_joined() {
    let said = said(THREE, &[&["a.rs", "b.rs"]]);
    assert_eq!(said.len(), 1);
    assert!(
        said[0].starts_with("x/src: a circle has grown by c.rs (")
            && said[0].contains("b.rs -> c.rs")
    );
}

#[test]
fn a_circle_that_shrank_has_its_entry_made_shorter() {
    let said = said(TWO, &[&["a.rs", "b.rs", "c.rs"]]);
    assert_eq!(said.len(), 2);
    assert!(said[0].contains(r#"&["a.rs", "b.rs"],"#));
    assert!(said[1].contains("is smaller now"));
}

#[test]
fn a_circle_that_is_open_has_its_entry_taken_out() {
    let said = said(&[("a", "b")], &[&["a.rs", "b.rs"]]);
    assert_eq!(said.len(), 1);
    assert!(said[0].contains("is open now"));
    let none = complaints(&BTreeMap::new(), &[("gone/src", &[&["a.rs", "b.rs"]])]);
    assert_eq!(none.len(), 1);
}
