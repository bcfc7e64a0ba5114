//! Tells what is drawn from what is hidden: by attributes, styles and style sheets.

use crate::FormatError;
use roxmltree::Node;
use simplecss::{AttributeOperator, Declaration, PseudoClass, StyleSheet};

/// Largest number of comparisons of a rule with an element.
const MAX_MATCHES: usize = 20_000_000;

/// Properties that decide whether something is drawn.
const PROPERTIES: [&str; 7] = [
    "display",
    "visibility",
    "opacity",
    "fill",
    "stroke",
    "fill-opacity",
    "stroke-opacity",
];

/// Properties that an element takes from its parent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    is_filled: bool,
    is_stroked: bool,
    fill_shows: bool,
    stroke_shows: bool,
    is_visible: bool,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            is_filled: true,
            is_stroked: false,
            fill_shows: true,
            stroke_shows: true,
            is_visible: true,
        }
    }
}

impl Style {
    /// Whether a line of this style is seen.
    pub fn is_seen(self) -> bool {
        let is_filled = self.is_filled && self.fill_shows;
        let is_stroked = self.is_stroked && self.stroke_shows;
        self.is_visible && (is_filled || is_stroked)
    }

    /// Whether words of this style are shown.
    pub fn is_visible(self) -> bool {
        self.is_visible
    }
}

/// The style sheets of a file.
pub(super) struct Styles<'a> {
    sheet: StyleSheet<'a>,
    matches: usize,
}

/// An element as style sheets see it.
struct Seen<'a, 'i>(Node<'a, 'i>);

impl simplecss::Element for Seen<'_, '_> {
    fn parent_element(&self) -> Option<Self> {
        self.0.parent_element().map(Seen)
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.0.prev_sibling_element().map(Seen)
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.0.tag_name().name() == name
    }

    fn attribute_matches(&self, name: &str, operator: AttributeOperator<'_>) -> bool {
        let value = self.0.attribute(name);
        value.is_some_and(|value| operator.matches(value))
    }

    fn pseudo_class_matches(&self, class: PseudoClass<'_>) -> bool {
        match class {
            PseudoClass::FirstChild => self.prev_sibling_element().is_none(),
            PseudoClass::Link
            | PseudoClass::Visited
            | PseudoClass::Hover
            | PseudoClass::Active
            | PseudoClass::Focus
            | PseudoClass::Lang(_) => false,
        }
    }
}

impl<'a> Styles<'a> {
    /// The rules of the style sheets that decide what is drawn.
    pub fn new(texts: impl Iterator<Item = &'a str>) -> Self {
        let mut sheet = StyleSheet::new();
        texts.for_each(|text| sheet.parse_more(text));
        sheet.rules.retain(|rule| {
            let decides = |one: &Declaration<'_>| PROPERTIES.contains(&one.name);
            rule.declarations.iter().any(decides)
        });
        Self { sheet, matches: 0 }
    }

    /// The style of an element whose parent has another; `None` if neither it nor what it holds is shown.
    ///
    /// # Errors
    /// The style sheets have too many rules for so many elements.
    pub fn of(&mut self, node: Node<'_, '_>, parent: Style) -> Result<Option<Style>, FormatError> {
        let mut values: [Option<&str>; PROPERTIES.len()] =
            PROPERTIES.map(|property| node.attribute(property));
        let mut is_important = [false; PROPERTIES.len()];
        self.matches += self.sheet.rules.len();
        if self.matches > MAX_MATCHES {
            return Err(FormatError::new(
                "the style sheets",
                "they have too many rules for a drawing of so many elements",
                "save the drawing as plain SVG, or with styles at its elements",
            ));
        }
        let mut put = |one: &Declaration<'_>, value| {
            let known = PROPERTIES.iter().position(|property| *property == one.name);
            if let Some(k) = known
                && (one.important || !is_important[k])
            {
                values[k] = Some(value);
                is_important[k] |= one.important;
            }
        };
        for rule in &self.sheet.rules {
            if rule.selector.matches(&Seen(node)) {
                for one in &rule.declarations {
                    put(one, one.value);
                }
            }
        }
        let own = node.attribute("style").unwrap_or_default();
        for one in simplecss::DeclarationTokenizer::from(own) {
            put(&one, one.value);
        }
        let [
            display,
            visibility,
            opacity,
            fill,
            stroke,
            fill_opacity,
            stroke_opacity,
        ] = values.map(|value| value.map(str::trim));
        if display == Some("none") || opacity.is_some_and(is_zero) {
            return Ok(None);
        }
        let painted = |value: Option<&str>, usual: bool| match value {
            None | Some("inherit") => usual,
            Some(value) => value != "none" && value != "transparent",
        };
        let shows = |value: Option<&str>, usual: bool| match value {
            None | Some("inherit") => usual,
            Some(value) => !is_zero(value),
        };
        Ok(Some(Style {
            is_filled: painted(fill, parent.is_filled),
            is_stroked: painted(stroke, parent.is_stroked),
            fill_shows: shows(fill_opacity, parent.fill_shows),
            stroke_shows: shows(stroke_opacity, parent.stroke_shows),
            is_visible: match visibility {
                None | Some("inherit") => parent.is_visible,
                Some(value) => value == "visible",
            },
        }))
    }
}

/// Whether an opacity is none at all.
fn is_zero(value: &str) -> bool {
    let number = value.trim_end_matches('%').trim().parse::<f64>();
    number.is_ok_and(|number| number <= 0.0)
}
