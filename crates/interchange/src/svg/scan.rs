//! Walks through the elements of a file and gathers what they draw.

use super::drawing::{Drawing, Element, Group, Line, Sign, Text};
use super::kinds::{KIND, LineKind, NOTCH, PANEL};
use super::scale::Scale;
use super::shape::{placed, shape};
use super::style::{Style, Styles};
use super::viewport::{Axis, Viewport, fitted, length, view_box};
use crate::FormatError;
use crate::xml::Xml;
use kurbo::{Affine, Point};
use roxmltree::Node;
use std::collections::HashMap;
use std::str::FromStr;
use svgtypes::Transform;
use toile_geometry::Vec2;

/// Largest number of vertices in a drawing.
const MAX_POINTS: usize = 200_000;
/// Largest number of elements that are drawn, those put in again and again counted each time.
const MAX_ELEMENTS: usize = 200_000;
/// Largest depth of elements in one another, those that are put in counted too.
const MAX_DEPTH: usize = 64;
/// Largest coordinate (units).
const MAX_COORDINATE: f64 = 1e7;

const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
const XLINK: &str = "http://www.w3.org/1999/xlink";
const SVG: &str = "http://www.w3.org/2000/svg";

/// Gathers what is drawn.
///
/// # Errors
/// A drawing beyond the limits, or numbers that are not finite: the line of the element, and a remedy.
pub(super) fn scan(xml: &Xml<'_>, scale: &Scale) -> Result<Drawing, FormatError> {
    let root = xml.root();
    let texts = xml.elements().filter(|node| is(*node, "style"));
    let texts: Vec<String> = texts
        .map(|node| {
            let parts = node.children().filter_map(|child| child.text());
            parts.collect()
        })
        .collect();
    let mut ids = HashMap::new();
    for node in xml.elements() {
        if let Some(id) = node.attribute("id") {
            ids.entry(id).or_insert(node);
        }
    }
    let mut scanner = Scanner {
        xml,
        styles: Styles::new(texts.iter().map(String::as_str)),
        ids,
        drawing: Drawing {
            groups: vec![Group::default()],
            ..Drawing::default()
        },
        is_freesewing: is_freesewing(root),
        elements: 0,
        points: 0,
    };
    let place = Place {
        affine: scale.root,
        viewport: scale.viewport(),
        group: 0,
        depth: 0,
        in_link: false,
    };
    if let Some(style) = scanner.styles.of(root, Style::default())? {
        scanner.children(root, style, &place)?;
    }
    Ok(scanner.drawing)
}

/// Whether FreeSewing drew a file: it states its version, or the class that its styles are for.
pub(super) fn is_freesewing(root: Node<'_, '_>) -> bool {
    let classes = root.attribute("class").unwrap_or_default();
    let mut classes = classes.split_whitespace();
    root.attribute("freesewing").is_some() || classes.any(|class| class == "freesewing")
}

/// Whether an element is one of SVG of a name.
fn is(node: Node<'_, '_>, name: &str) -> bool {
    let tag = node.tag_name();
    tag.name() == name && matches!(tag.namespace(), None | Some(SVG))
}

struct Scanner<'x, 'd, 's> {
    xml: &'x Xml<'d>,
    styles: Styles<'s>,
    ids: HashMap<&'x str, Node<'x, 'd>>,
    drawing: Drawing,
    is_freesewing: bool,
    elements: usize,
    points: usize,
}

/// The place at which elements are drawn.
#[derive(Clone, Debug)]
struct Place {
    /// From units of the elements to those of the drawing.
    affine: Affine,
    viewport: Viewport,
    group: usize,
    depth: usize,
    /// Whether they are put in by another element.
    in_link: bool,
}

impl<'x, 'd> Scanner<'x, 'd, '_> {
    fn refuse(&self, node: Node<'_, '_>, what: &str, hint: &str) -> FormatError {
        FormatError::new(format!("line {}", self.xml.line(node)), what, hint)
    }

    fn children(
        &mut self,
        node: Node<'x, 'd>,
        style: Style,
        place: &Place,
    ) -> Result<(), FormatError> {
        for child in node.children().filter(Node::is_element) {
            self.element(child, style, place)?;
        }
        Ok(())
    }

    fn element(
        &mut self,
        node: Node<'x, 'd>,
        parent: Style,
        place: &Place,
    ) -> Result<(), FormatError> {
        let name = match node.tag_name().namespace() {
            None | Some(SVG) => node.tag_name().name(),
            Some(_) => return Ok(()),
        };
        self.elements += 1;
        if self.elements > MAX_ELEMENTS {
            let what = format!("more than {MAX_ELEMENTS} elements would be drawn");
            let hint = "draw what is put in again and again once, and leave out what is no pattern";
            return Err(self.refuse(node, &what, hint));
        }
        if place.depth > MAX_DEPTH {
            let what = format!("elements lie more than {MAX_DEPTH} deep in one another");
            let hint = "ungroup the drawing, and see that nothing puts itself in";
            return Err(self.refuse(node, &what, hint));
        }
        let Some(style) = self.styles.of(node, parent)? else {
            return Ok(());
        };
        let mut inner = place.clone();
        inner.depth += 1;
        inner.affine = place.affine * self.transform(node)?;
        match name {
            "g" | "a" | "switch" => {
                inner.group = self.group(node, place.group);
                self.children(node, style, &inner)
            }
            "svg" => match self.nested(node, &mut inner) {
                true => self.children(node, style, &inner),
                false => Ok(()),
            },
            "use" => self.used(node, style, inner),
            "text" => {
                self.text(node, style, &inner);
                Ok(())
            }
            "image" => {
                self.drawing.leave_out("pictures");
                Ok(())
            }
            "script" => {
                self.drawing.leave_out("scripts");
                Ok(())
            }
            "foreignObject" => {
                self.drawing.leave_out("foreign objects");
                Ok(())
            }
            _ => self.lines(node, style, &inner),
        }
    }

    /// The map that an element's transformation is.
    fn transform(&self, node: Node<'_, '_>) -> Result<Affine, FormatError> {
        let Some(text) = node.attribute("transform") else {
            return Ok(Affine::IDENTITY);
        };
        let of = Transform::from_str(text.trim());
        let Ok(Transform { a, b, c, d, e, f }) = of else {
            let what = format!("the transformation {text:?} is damaged");
            let hint = "save the drawing anew in the program that it comes from";
            return Err(self.refuse(node, &what, hint));
        };
        Ok(Affine::new([a, b, c, d, e, f]))
    }

    fn group(&mut self, node: Node<'_, '_>, parent: usize) -> usize {
        let text = |name: &str| node.attribute(name).map(str::to_owned);
        let group = Group {
            parent: Some(parent),
            id: text("id").unwrap_or_default(),
            label: label(node),
            is_layer: node.attribute((INKSCAPE, "groupmode")) == Some("layer"),
            panel: text(PANEL),
        };
        self.drawing.groups.push(group);
        self.drawing.groups.len() - 1
    }

    /// Sets the place of what lies in a viewport of its own; `false` if it shows nothing.
    fn nested(&mut self, node: Node<'_, '_>, place: &mut Place) -> bool {
        let at = |name, axis| length(node, name, (axis, place.viewport));
        let corner = [at("x", Axis::X), at("y", Axis::Y)].map(Option::unwrap_or_default);
        let size = Viewport {
            width: at("width", Axis::X).unwrap_or(place.viewport.width),
            height: at("height", Axis::Y).unwrap_or(place.viewport.height),
        };
        place.affine *= Affine::translate((corner[0], corner[1]));
        shown_in(node, size, place)
    }

    fn used(
        &mut self,
        node: Node<'x, 'd>,
        style: Style,
        mut place: Place,
    ) -> Result<(), FormatError> {
        let href = node.attribute("href").or(node.attribute((XLINK, "href")));
        let Some(id) = href.and_then(|href| href.trim().strip_prefix('#')) else {
            self.drawing.leave_out("links to other files");
            return Ok(());
        };
        let at = |name, axis| length(node, name, (axis, place.viewport)).unwrap_or(0.0);
        let corner = (at("x", Axis::X), at("y", Axis::Y));
        if self.is_freesewing && !place.in_link {
            let at = place.affine * Point::new(corner.0, corner.1);
            self.drawing.signs.push(Sign {
                group: place.group,
                name: id.to_owned(),
                at: Vec2::new(at.x, at.y),
            });
            return Ok(());
        }
        let Some(&target) = self.ids.get(id) else {
            self.drawing
                .leave_out("links to elements that are not there");
            return Ok(());
        };
        place.affine *= Affine::translate(corner);
        place.in_link = true;
        place.depth += 1;
        let is_symbol = is(target, "symbol");
        if !is_symbol {
            return self.element(target, style, &place);
        }
        let Some(style) = self.styles.of(target, style)? else {
            return Ok(());
        };
        let own = |name, axis, usual| length(node, name, (axis, place.viewport)).unwrap_or(usual);
        let size = Viewport {
            width: own("width", Axis::X, place.viewport.width),
            height: own("height", Axis::Y, place.viewport.height),
        };
        place.group = self.group(target, place.group);
        match shown_in(target, size, &mut place) {
            true => self.children(target, style, &place),
            false => Ok(()),
        }
    }

    fn text(&mut self, node: Node<'_, '_>, style: Style, place: &Place) {
        let words: Vec<&str> = node
            .descendants()
            .filter(Node::is_text)
            .filter_map(|node| node.text())
            .flat_map(str::split_whitespace)
            .collect();
        if words.is_empty() || !style.is_visible() {
            return;
        }
        // The place of the first part that says one.
        let first = |name: &str, axis| {
            let parts = node.descendants().filter(Node::is_element);
            let mut places = parts.filter_map(|part| {
                let value = part.attribute(name)?.split([' ', ',']).next()?;
                value
                    .parse::<f64>()
                    .ok()
                    .or_else(|| length(part, name, (axis, place.viewport)))
            });
            places.next().filter(|value| value.is_finite())
        };
        let at = Point::new(
            first("x", Axis::X).unwrap_or(0.0),
            first("y", Axis::Y).unwrap_or(0.0),
        );
        let at = place.affine * at;
        self.drawing.texts.push(Text {
            group: place.group,
            at: Vec2::new(at.x, at.y),
            words: words.join(" "),
        });
    }

    fn lines(
        &mut self,
        node: Node<'_, '_>,
        style: Style,
        place: &Place,
    ) -> Result<(), FormatError> {
        if !style.is_seen() {
            return Ok(());
        }
        let Some(shape) = shape(node, place.viewport) else {
            return Ok(());
        };
        if shape.is_damaged {
            self.drawing.leave_out("ends of damaged paths");
        }
        let text = |name: &str| node.attribute(name).unwrap_or_default().to_owned();
        let classes = node.attribute("class").unwrap_or_default();
        let element = self.drawing.elements.len();
        let notch = node.attribute(NOTCH);
        self.drawing.elements.push(Element {
            group: place.group,
            id: text("id"),
            label: label(node),
            classes: classes.split_whitespace().map(str::to_owned).collect(),
            marker: text("marker-start"),
            words: text("data-text"),
            kind: node
                .attribute(KIND)
                .and_then(|word| LineKind::of(word, notch)),
        });
        for line in &shape.lines {
            let shape = placed(line, place.affine);
            self.points += shape.len();
            if self.points > MAX_POINTS {
                let what = format!("the drawing has more than {MAX_POINTS} points");
                let hint = "simplify its paths, or save each piece in a file of its own";
                return Err(self.refuse(node, &what, hint));
            }
            let chords = shape.chords(0);
            let is_far = |value: f64| !value.is_finite() || value.abs() > MAX_COORDINATE;
            if chords.points.iter().any(|p| is_far(p.x) || is_far(p.y)) {
                let what = "a coordinate is no number, or beyond all measure";
                let hint = "mend the element, or take it out of the drawing";
                return Err(self.refuse(node, what, hint));
            }
            self.drawing.lines.push(Line { element, shape });
        }
        Ok(())
    }
}

/// Sets the place of what a view box shows in a viewport of a size; `false` if that is nothing.
fn shown_in(node: Node<'_, '_>, size: Viewport, place: &mut Place) -> bool {
    if size.width <= 0.0 || size.height <= 0.0 {
        return false;
    }
    place.viewport = size;
    if let Some(shown) = view_box(node) {
        let [.., width, height] = shown;
        if width <= 0.0 || height <= 0.0 {
            return false;
        }
        place.affine *= fitted(node, shown, size);
        place.viewport = Viewport { width, height };
    }
    true
}

/// The label of an element, or the title that stands in it.
fn label(node: Node<'_, '_>) -> Option<String> {
    let own = node.attribute((INKSCAPE, "label"));
    let title = || {
        let mut children = node.children();
        children.find(|child| is(*child, "title"))?.text()
    };
    let label = own.or_else(title).map(str::trim);
    label.filter(|label| !label.is_empty()).map(str::to_owned)
}
