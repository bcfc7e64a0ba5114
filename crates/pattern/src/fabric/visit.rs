//! Figures of a material as fields of a pattern file, in the order of their table.

use crate::fields::{Choice, Group, ValueField, Visitor, VisitorMut, group, key};
use toile_fabric::{Access, Compression, Domain, FIGURES, Figure, Material};

impl Choice for Compression {}

/// The figures to visit, by whether files must have them.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Presence {
    /// Figures that every pattern file has.
    Always,
    /// Figures that files leave out if they have their default value.
    UnlessDefault,
}

fn figures(presence: Presence) -> impl Iterator<Item = &'static Figure> {
    FIGURES
        .iter()
        .filter(move |figure| figure.is_always_written == (presence == Presence::Always))
}

/// The field of a figure that has a single component.
fn field(figure: &Figure, is_default: bool) -> ValueField {
    let field = key(figure.pattern_key);
    match figure.is_always_written {
        true => field,
        false => field.left_out_if(is_default),
    }
}

/// The list of the components of a figure that has several.
fn list(figure: &Figure, is_default: bool) -> Group {
    let list = group(figure.pattern_key);
    match figure.is_always_written {
        true => list,
        false => list.left_out_if(is_default),
    }
}

/// The field of a component in the list of its figure.
fn component(figure: &Figure, index: usize) -> ValueField {
    let field = key(figure.components[index]);
    match figure.domain {
        Domain::Limit => field.null_at(f64::INFINITY),
        Domain::Positive | Domain::NotNegative | Domain::Ratio | Domain::Share => field,
    }
}

/// Passes the figures of a material to a visitor.
pub(super) trait VisitFigures<V: ?Sized> {
    /// Passes the figures with this presence to the visitor `v`.
    fn visit_figures(self, presence: Presence, v: &mut V);
}

/// Visits all figures with a presence. Written once for shared and once for mutable references.
macro_rules! visit {
    ($material:ident, $presence:ident, $v:ident, $get:ident, $iter:ident) => {
        for figure in figures($presence) {
            let is_default = figure.is_default($material);
            match figure.access {
                Access::Numbers { $get: get, .. } => match get($material) {
                    [number] => $v.value(field(figure, is_default), number),
                    numbers => $v.list(list(figure, is_default), &mut |v| {
                        for (k, number) in numbers.$iter().enumerate() {
                            v.value(component(figure, k), number);
                        }
                    }),
                },
                Access::Optional { $get: get, .. } => {
                    let number = get($material);
                    $v.optional(figure.pattern_key, number);
                    if let Some(number) = number {
                        $v.value(key(figure.pattern_key), number);
                    }
                }
                Access::Compression { $get: get, .. } => {
                    $v.value(field(figure, is_default), get($material));
                }
            }
        }
    };
}

impl<'a> VisitFigures<dyn Visitor<'a> + '_> for &'a Material {
    fn visit_figures(self, presence: Presence, v: &mut (dyn Visitor<'a> + '_)) {
        visit!(self, presence, v, get, iter);
    }
}

impl VisitFigures<dyn VisitorMut + '_> for &mut Material {
    fn visit_figures(self, presence: Presence, v: &mut (dyn VisitorMut + '_)) {
        visit!(self, presence, v, get_mut, iter_mut);
    }
}
