//! The document while it is built from a file: sheets with their points and curves, names of formulas, and
//! what was left out.

use super::expression::Expression;
use super::kinds::{FileUnit, LENGTH, PLAIN, Quantity, Symbol};
use super::quantities::Quantities;
use super::things::{CurveThing, PointThing, Thing};
use super::translate::{Scope, translated, translated_single, value};
use crate::exchange::{Guess, Loss};
use crate::part_names::part_name;
use roxmltree::Node;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;
use toile_geometry::{Curve as Piece, Path, Vec2};
use toile_pattern::{
    Curve, CurveId, CurveRule, Formula, Names, Number, Pattern, Point, PointId, PointRule, Sheet,
    SheetId,
};

/// Beginnings of the names of a curve's values.
const OF_CURVES: [&str; 9] = [
    "", "Angle1", "Angle2", "C1Length", "C2Length", "Radius", "Radius1", "Radius2", "Rotation",
];

/// A sheet while it is built, with the names that are taken on it.
#[derive(Default)]
pub(super) struct SheetInWork {
    pub sheet: Sheet,
    points: BTreeSet<String>,
    curves: BTreeSet<String>,
    /// Straight curves, by their ends.
    lines: BTreeMap<[PointId; 2], CurveId>,
    /// Copies of points of other sheets.
    copies: BTreeMap<PointId, PointThing>,
    /// Copies of curves of other sheets.
    curve_copies: BTreeMap<CurveId, Arc<CurveThing>>,
}

/// A number of a tool: for the document, as a formula, and its value for the base size.
#[derive(Clone, Debug)]
pub(super) struct Slot {
    /// The number for the document.
    pub number: Number,
    /// Text in our formulas, a primary expression.
    pub text: String,
    /// Value for the base size (m), (rad) or plain.
    pub value: f64,
}

/// The document while it is built.
pub(super) struct Build {
    pub pattern: Pattern,
    pub unit: FileUnit,
    /// Whether a negative length on a spline counts from its end, as newer files mean it.
    pub from_ends: bool,
    pub sheets: Vec<SheetInWork>,
    /// Parts of the file by their numbers.
    pub things: HashMap<u32, Thing>,
    /// All points, in the order in which they were made.
    pub places: Vec<PointThing>,
    /// Names of the file's points, by the document's.
    pub file_names: HashMap<PointId, String>,
    /// Names of the document's points.
    pub point_names: HashMap<PointId, String>,
    /// Curves of the document by their ids.
    pub wholes: HashMap<CurveId, Arc<CurveThing>>,
    /// Centres and radii of arcs.
    pub circles: HashMap<CurveId, (PointThing, Slot)>,
    /// Points by their names, the latest last: drawings may use a name again.
    named: HashMap<String, Vec<PointThing>>,
    /// Pairs of points that a tool joins by a line, by both names as in `A_B`; the latest of one name.
    joined: HashMap<String, [PointThing; 2]>,
    /// Values that formulas name.
    pub symbols: HashMap<String, Symbol>,
    /// Numbers of parts of cut curves, under which the whole curve is known.
    pub parts: BTreeSet<u32>,
    /// Quantities of names that are known before their values.
    pub quantities: HashMap<String, Quantity>,
    /// Names that formulas of the file use.
    pub used: BTreeSet<String>,
    pub guesses: Vec<Guess>,
    pub losses: Vec<Loss>,
    pub notes: Vec<String>,
}

impl Build {
    pub fn new(unit: FileUnit) -> Self {
        Self {
            pattern: Pattern::default(),
            unit,
            from_ends: false,
            sheets: Vec::new(),
            things: HashMap::new(),
            places: Vec::new(),
            file_names: HashMap::new(),
            point_names: HashMap::new(),
            wholes: HashMap::new(),
            circles: HashMap::new(),
            named: HashMap::new(),
            joined: HashMap::new(),
            symbols: HashMap::new(),
            parts: BTreeSet::new(),
            quantities: HashMap::new(),
            used: BTreeSet::new(),
            guesses: Vec::new(),
            losses: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Begins a sheet.
    pub fn add_sheet(&mut self, name: String) {
        let sheet = Sheet {
            id: self.pattern.ids.take::<SheetId>(),
            name,
            ..Sheet::default()
        };
        self.sheets.push(SheetInWork {
            sheet,
            ..SheetInWork::default()
        });
    }

    /// Index of the sheet that is built.
    pub fn current(&self) -> usize {
        self.sheets.len().saturating_sub(1)
    }

    /// Adds a point to the sheet that is built.
    pub fn add_point(&mut self, name: &str, rule: PointRule, at: Vec2) -> PointThing {
        let id: PointId = self.pattern.ids.take();
        let sheet = self.current();
        if let Some(own) = self.sheets.get_mut(sheet) {
            let name = part_name(name, &mut own.points);
            self.point_names.insert(id, name.clone());
            own.sheet.points.push(Arc::new(Point { id, name, rule }));
        }
        let made = PointThing { id, at, sheet };
        self.places.push(made);
        made
    }

    /// Adds a curve to the sheet that is built.
    pub fn add_curve(
        &mut self,
        name: &str,
        ends: [PointThing; 2],
        rule: CurveRule,
        pieces: Vec<Piece>,
    ) -> Arc<CurveThing> {
        let id: CurveId = self.pattern.ids.take();
        let sheet = self.current();
        if let Some(own) = self.sheets.get_mut(sheet) {
            let name = part_name(name, &mut own.curves);
            let ends = ends.map(|end| end.id);
            own.sheet.curves.push(Arc::new(Curve {
                id,
                name,
                ends,
                rule,
            }));
        }
        let made = Arc::new(CurveThing {
            id,
            ends,
            path: Path::new(pieces),
            sheet,
            name: name.to_owned(),
            length: format!("length(curve ?{})", id.0),
            start: None,
            is_whole: true,
        });
        self.wholes.insert(id, made.clone());
        made
    }

    /// Name of a point in the document.
    pub fn point_name(&self, point: PointThing) -> String {
        self.point_names.get(&point.id).cloned().unwrap_or_default()
    }

    /// Name of a point in the file.
    pub fn file_name(&self, point: PointThing) -> String {
        let known = self.file_names.get(&point.id).cloned();
        known.unwrap_or_else(|| self.point_name(point))
    }

    /// The straight curve between two points, which is added if there is none; it may run either way.
    pub fn line_between(&mut self, name: &str, ends: [PointThing; 2]) -> CurveId {
        let sheet = self.current();
        let ids = ends.map(|end| end.id);
        let known = self.sheets.get(sheet).and_then(|own| {
            let back = [ids[1], ids[0]];
            own.lines.get(&ids).or(own.lines.get(&back)).copied()
        });
        if let Some(known) = known {
            return known;
        }
        let [start, end] = ends.map(|end| end.at);
        let piece = Piece::Line { start, end };
        let curve = self.add_curve(name, ends, CurveRule::Line, vec![piece]);
        if let Some(own) = self.sheets.get_mut(sheet) {
            own.lines.insert(ids, curve.id);
        }
        curve.id
    }

    /// A number of the file as a number of the document.
    ///
    /// # Errors
    /// The formula cannot be read, or names what is not there: in words.
    pub fn slot(&self, text: &str, want: Quantity) -> Result<Slot, String> {
        let formula = Expression::read(text)?;
        self.slot_of(&formula, want)
    }

    fn slot_of(&self, formula: &Expression, want: Quantity) -> Result<Slot, String> {
        let number = value(formula, self)?;
        if !number.is_finite() {
            return Err("its value is no number".to_owned());
        }
        let value = self.unit.si(number, want);
        let text = translated(formula, want, self)?;
        let single = translated_single(formula, want, self)?;
        let mut has_names = false;
        formula.each_name(&mut |_| has_names = true);
        let number = match has_names {
            true => self.formula(&text)?,
            false => Number::Value(value),
        };
        Ok(Slot {
            number,
            text: single,
            value,
        })
    }

    /// A formula of ours, whose parts are named by their ids.
    ///
    /// # Errors
    /// It is too long or too deep: in words.
    pub fn formula(&self, text: &str) -> Result<Number, String> {
        let formula = Formula::parse(text, &Names::default());
        let formula = formula.map_err(|error| format!("{text:?}: {error}"))?;
        Ok(Number::Formula(formula))
    }

    /// The number in an attribute of a tool.
    ///
    /// # Errors
    /// The attribute is missing, or has no value: in words.
    pub fn number(
        &self,
        node: Node<'_, '_>,
        attribute: &str,
        want: Quantity,
    ) -> Result<Slot, String> {
        let text = attribute_of(node, attribute)?;
        let slot = self.slot(text, want);
        slot.map_err(|what| format!("its {attribute}: {what}"))
    }

    /// The point that an attribute of a tool names; a point of another sheet is copied to the one that is
    /// built.
    ///
    /// # Errors
    /// There is no such point: in words.
    pub fn point(&mut self, node: Node<'_, '_>, attribute: &str) -> Result<PointThing, String> {
        match self.things.get(&reference(node, attribute)?) {
            Some(Thing::Point(point)) => Ok(self.on_this_sheet(*point)),
            Some(Thing::Curve(_)) => Err(format!("its {attribute} is a curve, not a point")),
            None => Err(format!("its {attribute} is not there or was left out")),
        }
    }

    /// A point, or its copy on the sheet that is built.
    pub fn on_this_sheet(&mut self, point: PointThing) -> PointThing {
        let sheet = self.current();
        if point.sheet == sheet {
            return point;
        }
        let known = self
            .sheets
            .get(sheet)
            .and_then(|own| own.copies.get(&point.id));
        if let Some(known) = known {
            return *known;
        }
        let name = self.point_name(point);
        let coordinate = |axis: &str, value: f64| {
            let formula = self.formula(&format!("{axis}(?{})", point.id.0));
            formula.unwrap_or(Number::Value(value))
        };
        let rule = PointRule::At {
            x: coordinate("x", point.at.x),
            y: coordinate("y", point.at.y),
        };
        let copy = self.add_point(&name, rule, point.at);
        let name = self.file_name(point);
        self.file_names.insert(copy.id, name);
        if let Some(own) = self.sheets.get_mut(sheet) {
            own.copies.insert(point.id, copy);
        }
        copy
    }

    /// A curve, or its copy on the sheet that is built.
    ///
    /// # Errors
    /// A closed curve of another sheet, which a copy cannot follow: in words.
    pub fn curve_on_this_sheet(
        &mut self,
        curve: &Arc<CurveThing>,
    ) -> Result<Arc<CurveThing>, String> {
        let sheet = self.current();
        if curve.sheet == sheet {
            return Ok(curve.clone());
        }
        let own = self.sheets.get(sheet);
        let known = own.and_then(|own| own.curve_copies.get(&curve.id).cloned());
        let whole = match known {
            Some(known) => known,
            None => {
                let of = self.wholes.get(&curve.id).cloned();
                let of = of.ok_or("its curve is not there")?;
                if (of.ends[1].at - of.ends[0].at).norm() <= 1e-9 {
                    return Err(format!(
                        "{} of another drawing begins where it ends",
                        of.name
                    ));
                }
                let ends = of.ends.map(|end| self.on_this_sheet(end));
                let rule = CurveRule::Copy { of: of.id };
                let made = self.add_curve(&of.name, ends, rule, of.path.curves().to_vec());
                if let Some(own) = self.sheets.get_mut(sheet) {
                    own.curve_copies.insert(of.id, made.clone());
                }
                made
            }
        };
        if curve.is_whole {
            return Ok(whole);
        }
        Ok(Arc::new(CurveThing {
            id: whole.id,
            ends: curve.ends.map(|end| self.on_this_sheet(end)),
            sheet,
            ..(**curve).clone()
        }))
    }

    /// The curve that an attribute of a tool names, or its copy on the sheet that is built.
    ///
    /// # Errors
    /// There is no such curve, or it cannot be copied: in words.
    pub fn curve(
        &mut self,
        node: Node<'_, '_>,
        attribute: &str,
    ) -> Result<Arc<CurveThing>, String> {
        let number = reference(node, attribute)?;
        match self.things.get(&number) {
            Some(Thing::Curve(curve)) => {
                if self.parts.contains(&number) {
                    let name = node.attribute("name").unwrap_or_default();
                    self.notes.push(format!(
                        "{name:?} cuts a part of {}: the whole curve is taken, as Valentina does since 0.2.5",
                        curve.name
                    ));
                }
                let curve = curve.clone();
                self.curve_on_this_sheet(&curve)
            }
            Some(Thing::Point(_)) => Err(format!("its {attribute} is a point, not a curve")),
            None => Err(format!("its {attribute} is not there or was left out")),
        }
    }

    /// Whether a formula of the file uses a name that is not known yet.
    pub fn is_wanted(&self, name: &str) -> bool {
        self.used.contains(name) && !self.symbols.contains_key(name)
    }

    /// The bulge of a curve of the document that is an arc.
    pub fn bulge_of(&self, curve: CurveId) -> Option<Number> {
        let mut curves = self.sheets.iter().flat_map(|own| &own.sheet.curves);
        match &curves.find(|one| one.id == curve)?.rule {
            CurveRule::Arc { bulge } => Some(bulge.clone()),
            CurveRule::Line
            | CurveRule::Spline { .. }
            | CurveRule::Mirrored { .. }
            | CurveRule::Copy { .. } => None,
        }
    }

    /// Gives the values of a curve the names that they have by another name of the curve too.
    pub fn name_also(&mut self, curve: &str, alias: &str) {
        let kind = curve.split('_').next().unwrap_or_default();
        for prefix in OF_CURVES {
            if let Some(symbol) = self.symbols.get(&format!("{prefix}{curve}")).cloned() {
                self.symbols
                    .insert(format!("{prefix}{kind}_{alias}"), symbol);
            }
        }
    }

    /// Gives a length a name for formulas.
    pub fn name_length(&mut self, name: String, text: &str, metres: f64) {
        self.name_value(name, text, LENGTH, metres);
    }

    /// Gives a value (m), (rad) or plain a name for formulas.
    pub fn name_value(&mut self, name: String, text: &str, quantity: Quantity, si: f64) {
        let symbol = Symbol {
            text: text.to_owned(),
            quantity,
            value: self.unit.of_si(si, quantity),
        };
        self.symbols.insert(name, symbol);
    }

    /// Gives a point a name for formulas.
    pub fn name_point(&mut self, name: String, point: PointThing) {
        self.named.entry(name).or_default().push(point);
    }

    /// Names the line by which a tool joins two points for formulas.
    pub fn join(&mut self, ends: [PointThing; 2]) {
        let [a, b] = ends.map(|end| self.file_name(end));
        self.joined.insert(format!("{a}_{b}"), ends);
    }

    /// Names of curves by which formulas know a length, by its text.
    pub fn names_of_length<'a>(&'a self, text: &'a str) -> impl Iterator<Item = &'a str> {
        let all = self.symbols.iter();
        let same = all.filter(move |(name, symbol)| {
            symbol.text == text
                && ["Spl", "Arc", "ElArc"]
                    .iter()
                    .any(|kind| name.starts_with(kind))
        });
        same.map(|(name, _)| name.as_str())
    }

    /// The two points of a name such as `Line_A_B`; names of points may have underscores themselves.
    fn two_points(&self, rest: &str) -> Option<[PointThing; 2]> {
        if let Some(joined) = self.joined.get(rest) {
            return Some(*joined);
        }
        let mut splits = rest.match_indices('_');
        splits.find_map(|(at, _)| {
            let firsts = self.named.get(&rest[..at])?;
            let seconds = self.named.get(&rest[at + 1..])?;
            latest_pair(firsts, seconds)
        })
    }

    fn derived(&self, name: &str) -> Option<Symbol> {
        if let Some(rest) = name.strip_prefix("Line_") {
            let [a, b] = self.two_points(rest)?;
            return Some(Symbol {
                text: format!("distance(?{}, ?{})", a.id.0, b.id.0),
                quantity: LENGTH,
                value: self.unit.of_si((b.at - a.at).norm(), LENGTH),
            });
        }
        let [a, b] = self.two_points(name.strip_prefix("AngleLine_")?)?;
        let way = b.at - a.at;
        let direction = format!("angle(?{}, ?{})", a.id.0, b.id.0);
        let degrees = way.y.atan2(way.x).to_degrees();
        Some(Symbol {
            // Directions there run from 0 to 360 degrees.
            text: format!("if({direction} < 0, {direction} + 360deg, {direction})"),
            quantity: Quantity::Angle,
            value: if degrees < 0.0 {
                degrees + 360.0
            } else {
                degrees
            },
        })
    }

    /// A point for a tool that has no place in the base size: the other program puts it at the origin.
    pub fn at_origin(&mut self, name: &str, why: &str) -> PointThing {
        let why = format!("{why}: it stays at the origin, where the other program has it");
        self.losses.push(Loss::at(name, "a construction", why));
        self.add_point(name, PointRule::at(0.0, 0.0), Vec2::zeros())
    }

    /// A point in the place of another, for a tool that has no other place in the base size.
    pub fn at_place_of(&mut self, name: &str, base: PointThing, why: &str) -> PointThing {
        let rule = PointRule::Offset {
            base: base.id,
            x: 0.0.into(),
            y: 0.0.into(),
        };
        self.losses.push(Loss::at(name, "a construction", why));
        self.add_point(name, rule, base.at)
    }

    /// Says that a tool was left out.
    pub fn left_out(&mut self, place: String, what: String, why: String) {
        self.losses.push(Loss::at(place, what, why));
    }
}

impl Quantities for Build {
    fn quantity(&self, name: &str) -> Option<Quantity> {
        let known = self.symbols.get(name).map(|symbol| symbol.quantity);
        known
            .or_else(|| self.quantities.get(name).copied())
            .or_else(|| quantity_by_name(name))
    }
}

/// The quantity that the beginning of a name tells.
pub(super) fn quantity_by_name(name: &str) -> Option<Quantity> {
    const LENGTHS: &[&str] = &[
        "Line_",
        "Spl_",
        "SplPath_",
        "Arc_",
        "ElArc_",
        "C1Length",
        "C2Length",
        "RadiusArc_",
        "Radius1ElArc_",
        "Radius2ElArc_",
        "CurrentLength",
        "CurrentSeamAllowance",
        "Len",
    ];
    const ANGLES: &[&str] = &[
        "AngleLine_",
        "Angle1",
        "Angle2",
        "AngleArc_",
        "RotationElArc_",
    ];
    let begins = |all: &[&str]| all.iter().any(|start| name.starts_with(start));
    match (begins(LENGTHS), begins(ANGLES)) {
        (true, _) => Some(LENGTH),
        (_, true) => Some(Quantity::Angle),
        _ => None,
    }
}

impl Scope for Build {
    fn symbol(&self, name: &str) -> Option<Symbol> {
        let known = self.symbols.get(name).cloned();
        known.or_else(|| self.derived(name))
    }

    fn unit(&self) -> FileUnit {
        self.unit
    }
}

/// Of points with two names, the pair of the latest drawing that has both; else the latest of each.
fn latest_pair(firsts: &[PointThing], seconds: &[PointThing]) -> Option<[PointThing; 2]> {
    let of_one_sheet = |first: &PointThing| {
        let mut all = seconds.iter().rev();
        let second = all.find(|second| second.sheet == first.sheet)?;
        Some([*first, *second])
    };
    let pairs = firsts.iter().rev().filter_map(of_one_sheet);
    let last = pairs.reduce(|best, next| match next[0].sheet > best[0].sheet {
        true => next,
        false => best,
    });
    last.or(Some([*firsts.last()?, *seconds.last()?]))
}

/// An attribute of an element.
///
/// # Errors
/// It is missing: in words.
pub(super) fn attribute_of<'a>(node: Node<'a, '_>, attribute: &str) -> Result<&'a str, String> {
    let text = node.attribute(attribute);
    text.ok_or_else(|| format!("it has no {attribute}"))
}

/// The number of another part in an attribute of an element.
///
/// # Errors
/// It is missing, or no number: in words.
pub(super) fn reference(node: Node<'_, '_>, attribute: &str) -> Result<u32, String> {
    let text = attribute_of(node, attribute)?.trim();
    let number = text.parse();
    number.map_err(|_| format!("its {attribute} {text:?} is no number of a part"))
}

/// The value of a plain number that an attribute may have.
pub(super) fn plain(build: &Build, node: Node<'_, '_>, attribute: &str) -> Option<f64> {
    let slot = build.slot(node.attribute(attribute)?, PLAIN).ok()?;
    Some(slot.value)
}
