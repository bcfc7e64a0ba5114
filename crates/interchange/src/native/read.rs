//! Reads a pattern file: head, sizes, variables, fabrics, sheets; ids and numbers.

use super::fitting::Fitting;
use super::item::{FieldsOfKind, Item, Written};
use super::json::Value;
use super::read_marker::marker;
use super::read_panel::panel;
use super::read_seam::{mark, name, seam};
use super::units::UNITS;
use super::values::{fabric, measurements};
use crate::FormatError;
use std::collections::HashMap;
use std::sync::Arc;
use toile_measure::Measurements;
use toile_pattern::{
    Curve, CurveRule, Diagnostic, DisplayUnit, Formula, Guide, GuideRun, Knot, Names, Number,
    PartId, Pattern, Point, PointRule, Sheet, Size, SizeId, Variable,
};

/// Reads how the garment is tried on.
pub type FittingReader = for<'a> fn(&mut Reader<'a>, &Item<'a>) -> Result<Fitting, FormatError>;

/// Reads the pattern at the root of a file, and by `fitting` how it is tried on.
pub fn read(
    root: &Item<'_>,
    fitting: FittingReader,
    notes: &mut Vec<Diagnostic>,
) -> Result<(Pattern, Fitting), FormatError> {
    // Formulas name parts, so the parts come first: names are bound in a second round.
    let (unbound, _) = Reader::new(Names::default()).document(root, fitting)?;
    let mut reader = Reader::new(Names::new(&unbound));
    let document = reader.document(root, fitting)?;
    notes.extend(reader.notes);
    Ok(document)
}

/// Kinds of points, by the fields that tell them.
const POINTS: &[FieldsOfKind<'_>] = &[
    (1, &["at"]),
    (1, &["curves", "index"]),
    (2, &["curve", "line", "index"]),
    (2, &["curve", "distance"]),
    (1, &["curve", "share"]),
    (1, &["crossing"]),
    (1, &["foot", "in"]),
    (1, &["mirror", "in"]),
    (1, &["mark", "line"]),
    (2, &["from", "offset"]),
    (2, &["from", "angle", "distance"]),
    (2, &["from", "toward", "distance"]),
    (1, &["from", "to", "along", "aside"]),
];

/// Kinds of curves; the last are straight.
const CURVES: &[FieldsOfKind<'_>] = &[
    (1, &["bulge"]),
    (1, &["handles", "knots", "to_length"]),
    (1, &["mirror", "in"]),
    (1, &["copy"]),
    (0, &[]),
];

/// Kinds of guides: at a height, or so far to the right.
const GUIDES: &[FieldsOfKind<'_>] = &[(1, &["y"]), (1, &["x"])];

/// Kinds of numbers that are objects.
const NUMBERS: &[FieldsOfKind<'_>] = &[
    (1, &["formula", "by"]),
    (1, &["usual", "sizes"]),
    (1, &["m"]),
    (1, &["rad"]),
];

/// The quantity that a number measures.
#[derive(Clone, Copy)]
pub enum Measure {
    Length,
    Angle,
    Plain,
}

/// State of the reader.
pub struct Reader<'a> {
    pub notes: Vec<Diagnostic>,
    unit: DisplayUnit,
    names: Names,
    /// Ids that parts of the file have.
    given: HashMap<u32, PartId>,
    /// Ids that are referred to, with their places.
    referred: Vec<(PartId, Item<'a>)>,
}

const HEAD: &[&str] = &[
    "toile",
    "kind",
    "name",
    "unit",
    "base_size",
    "sizes",
    "variables",
    "fabrics",
    "sheets",
    "panels",
    "seams",
    "markers",
    "guides",
    "fitting",
    "next_id",
];

impl<'a> Reader<'a> {
    fn new(names: Names) -> Self {
        Self {
            notes: Vec::new(),
            unit: DisplayUnit::default(),
            names,
            given: HashMap::new(),
            referred: Vec::new(),
        }
    }

    fn document(
        &mut self,
        root: &Item<'a>,
        fitting: FittingReader,
    ) -> Result<(Pattern, Fitting), FormatError> {
        let head = root.object(HEAD, &mut self.notes)?;
        if let Some(unit) = head.get("unit") {
            self.unit = unit.choice(UNITS)?;
        }
        let mut pattern = Pattern::new(head.need("name")?.text()?);
        pattern.unit = self.unit;
        for item in head.items("sizes")? {
            let fields = item.object(&["id", "name", "measurements"], &mut self.notes)?;
            let table = fields.need("measurements")?;
            pattern.sizes.push(Arc::new(Size {
                id: self.own(&fields.need("id")?)?,
                name: fields.need("name")?.name()?.to_owned(),
                measurements: self.measurements(&table)?,
            }));
        }
        if let Some(base) = head.get("base_size") {
            pattern.base_size = Some(self.reference(&base)?);
        }
        for item in head.items("variables")? {
            let fields = item.object(&["id", "name", "value"], &mut self.notes)?;
            pattern.variables.push(Arc::new(Variable {
                id: self.own(&fields.need("id")?)?,
                name: fields.need("name")?.name()?.to_owned(),
                number: self.number(&fields.need("value")?, Measure::Plain)?,
            }));
        }
        for item in head.items("fabrics")? {
            let fields = item.fields()?;
            let name = fields.need("name")?.name()?;
            let (_, mut cloth) = fabric(name, &item, &mut self.notes)?;
            cloth.id = self.own(&fields.need("id")?)?;
            pattern.fabrics.push(Arc::new(cloth));
        }
        for item in head.items("sheets")? {
            let sheet = self.sheet(&item)?;
            pattern.sheets.push(Arc::new(sheet));
        }
        for item in head.items("panels")? {
            let panel = panel(self, &item)?;
            pattern.panels.push(Arc::new(panel));
        }
        for item in head.items("seams")? {
            let seam = seam(self, &item)?;
            pattern.seams.push(Arc::new(seam));
        }
        for item in head.items("markers")? {
            let marker = marker(self, &item)?;
            pattern.markers.push(Arc::new(marker));
        }
        for item in head.items("guides")? {
            let guide = self.guide(&item)?;
            pattern.guides.push(Arc::new(guide));
        }
        let tried_on = match head.get("fitting") {
            Some(item) => fitting(self, &item)?,
            None => Fitting::default(),
        };
        pattern.ids.next = head.need("next_id")?.count()?;
        self.check_ids(&head.need("next_id")?, pattern.ids.next)?;
        Ok((pattern, tried_on))
    }

    /// A table of measurements.
    pub fn measurements(&mut self, item: &Item<'a>) -> Result<Measurements, FormatError> {
        measurements(item, self.unit, &mut self.notes)
    }

    /// The id of a part of the file.
    pub fn own<T: From<u32> + Into<PartId> + Copy>(
        &mut self,
        item: &Item<'a>,
    ) -> Result<T, FormatError> {
        let number = item.count()?;
        let id = T::from(number);
        match self.given.insert(number, id.into()) {
            None => Ok(id),
            Some(other) => Err(item.error(
                format!("the id {number} is that of {other} already"),
                "give each part an id of its own",
            )),
        }
    }

    /// The id of a part that is referred to.
    pub fn reference<T: From<u32> + Into<PartId> + Copy>(
        &mut self,
        item: &Item<'a>,
    ) -> Result<T, FormatError> {
        let id = T::from(item.count()?);
        self.referred.push((id.into(), item.clone()));
        Ok(id)
    }

    /// Exactly `N` ids of parts that are referred to.
    pub fn references<T: From<u32> + Into<PartId> + Copy + Default, const N: usize>(
        &mut self,
        item: &Item<'a>,
    ) -> Result<[T; N], FormatError> {
        let items: [Item<'a>; N] = item.exactly()?;
        let mut ids = [T::default(); N];
        for (id, item) in ids.iter_mut().zip(&items) {
            *id = self.reference(item)?;
        }
        Ok(ids)
    }

    /// Refuses ids of another kind, and ids that were never given. A part that was removed may be
    /// referred to: what refers to it waits for its return.
    fn check_ids(&self, item: &Item<'_>, next: u32) -> Result<(), FormatError> {
        if let Some((highest, id)) = self.given.iter().max_by_key(|(number, _)| **number)
            && *highest >= next
        {
            return Err(item.error(
                format!("the next id is {next}, and {id} has been given"),
                format!("write {}", highest.saturating_add(1)),
            ));
        }
        for (wanted, item) in &self.referred {
            let found = self.given.get(&wanted.number());
            if found.is_some_and(|found| found != wanted) || wanted.number() >= next {
                let what = match found {
                    Some(other) => format!("{wanted} is referred to, but the file has {other}"),
                    None => format!("{wanted} is referred to, which was never given"),
                };
                return Err(item.error(what, "refer to a part of the right kind"));
            }
        }
        Ok(())
    }

    /// A number: a value, a formula, an adjusted formula, a value a size.
    pub fn number(&mut self, item: &Item<'a>, measure: Measure) -> Result<Number, FormatError> {
        if let Value::Object(_) = item.node.value {
            let fields = item.fields()?;
            fields.of_one_kind(&[], NUMBERS)?;
            if let Some(formula) = fields.get("formula") {
                item.object(&["formula", "by"], &mut self.notes)?;
                return Ok(Number::Adjusted {
                    formula: self.formula(&formula, formula.text()?)?,
                    by: self.value(&fields.need("by")?, measure)?,
                });
            }
            if let Some(usual) = fields.get("usual") {
                item.object(&["usual", "sizes"], &mut self.notes)?;
                let usual = Box::new(self.number(&usual, measure)?);
                let mut sizes: Vec<(SizeId, f64)> = Vec::new();
                for pair in fields.need("sizes")?.list()? {
                    let [size, value]: [Item<'a>; 2] = pair.exactly()?;
                    let id = self.reference(&size)?;
                    if sizes.iter().any(|known| known.0 == id) {
                        let what = format!("{id} is given two values");
                        return Err(size.error(what, "keep one of them"));
                    }
                    sizes.push((id, self.value(&value, measure)?));
                }
                return Ok(Number::PerSize { usual, sizes });
            }
        }
        match self.written(item, measure)? {
            Written::Value(value) => Ok(Number::Value(value)),
            Written::Formula(text) => self.formula(item, text).map(Number::Formula),
        }
    }

    fn written(&self, item: &Item<'a>, measure: Measure) -> Result<Written<'a>, FormatError> {
        match measure {
            Measure::Length => item.length(self.unit),
            Measure::Angle => item.angle(),
            Measure::Plain => item.plain(),
        }
    }

    /// A number that is a value.
    pub fn value(&self, item: &Item<'a>, measure: Measure) -> Result<f64, FormatError> {
        item.fixed(&self.written(item, measure)?)
    }

    fn formula(&mut self, item: &Item<'a>, text: &str) -> Result<Formula, FormatError> {
        let formula = Formula::parse(text, &self.names).map_err(|error| {
            let column = error.column;
            let what = format!("the formula {text:?}, column {column}: {}", error.message);
            item.error(what, error.hint)
        })?;
        let named = formula.references().into_iter();
        self.referred.extend(named.map(|part| (part, item.clone())));
        Ok(formula)
    }

    /// Two lengths [m].
    pub fn place(&self, item: &Item<'a>) -> Result<[f64; 2], FormatError> {
        let [x, y]: [Item<'a>; 2] = item.exactly()?;
        Ok([
            self.value(&x, Measure::Length)?,
            self.value(&y, Measure::Length)?,
        ])
    }

    fn lengths(&mut self, item: &Item<'a>) -> Result<[Number; 2], FormatError> {
        let [x, y]: [Item<'a>; 2] = item.exactly()?;
        Ok([
            self.number(&x, Measure::Length)?,
            self.number(&y, Measure::Length)?,
        ])
    }

    fn guide(&mut self, item: &Item<'a>) -> Result<Guide, FormatError> {
        let fields = item.object(&["id", "x", "y"], &mut self.notes)?;
        fields.of_one_kind(&["id"], GUIDES)?;
        let (runs, at) = match fields.get("x") {
            Some(x) => (GuideRun::Vertical, x),
            None => (GuideRun::Horizontal, fields.need("y")?),
        };
        Ok(Guide {
            id: self.own(&fields.need("id")?)?,
            runs,
            at: self.value(&at, Measure::Length)?,
        })
    }

    fn sheet(&mut self, item: &Item<'a>) -> Result<Sheet, FormatError> {
        let known = &["id", "name", "on", "table", "points", "curves"];
        let fields = item.object(known, &mut self.notes)?;
        let mut sheet = Sheet {
            id: self.own(&fields.need("id")?)?,
            name: fields.need("name")?.name()?.to_owned(),
            ..Sheet::default()
        };
        if let Some(table) = fields.get("table") {
            sheet.on_table = self.place(&table)?;
        }
        if let Some(on) = fields.get("on") {
            let stage = on.object(&["panel", "after"], &mut self.notes)?;
            let panel = self.reference(&stage.need("panel")?)?;
            let after = match stage.get("after") {
                Some(after) => Some(self.reference(&after)?),
                None => None,
            };
            sheet.on = Some((panel, after));
        }
        for item in fields.items("points")? {
            let point = self.point(&item)?;
            sheet.points.push(Arc::new(point));
        }
        for item in fields.items("curves")? {
            let curve = self.curve(&item)?;
            sheet.curves.push(Arc::new(curve));
        }
        Ok(sheet)
    }

    fn point(&mut self, item: &Item<'a>) -> Result<Point, FormatError> {
        let known = &[
            "id", "name", "at", "from", "offset", "angle", "distance", "to", "along", "aside",
            "toward", "curve", "share", "crossing", "curves", "line", "index", "foot", "mirror",
            "in", "mark",
        ];
        let fields = item.object(known, &mut self.notes)?;
        fields.of_one_kind(&["id", "name"], POINTS)?;
        Ok(Point {
            id: self.own(&fields.need("id")?)?,
            name: fields.need("name")?.name()?.to_owned(),
            rule: self.rule(&fields)?,
        })
    }

    fn rule(&mut self, fields: &super::item::Object<'a>) -> Result<PointRule, FormatError> {
        let index = |fields: &super::item::Object<'a>| -> Result<u16, FormatError> {
            let Some(item) = fields.get("index") else {
                return Ok(0);
            };
            u16::try_from(item.count()?)
                .map_err(|_| item.error("there are not that many crossings", "write 0 or more"))
        };
        if let Some(at) = fields.get("at") {
            let [x, y] = self.lengths(&at)?;
            return Ok(PointRule::At { x, y });
        }
        if let Some(at) = fields.get("mark") {
            return Ok(PointRule::Mark {
                line: name(self, &fields.need("line")?)?,
                at: mark(self, &at)?,
            });
        }
        if let Some(curves) = fields.get("curves") {
            return Ok(PointRule::CurveCrossing {
                curves: self.references(&curves)?,
                index: index(fields)?,
            });
        }
        if let Some(curve) = fields.get("curve") {
            let curve = self.reference(&curve)?;
            if let Some(line) = fields.get("line") {
                return Ok(PointRule::LineCrossing {
                    line: self.references(&line)?,
                    curve,
                    index: index(fields)?,
                });
            }
            if let Some(distance) = fields.get("distance") {
                return Ok(PointRule::AlongCurve {
                    curve,
                    distance: self.number(&distance, Measure::Length)?,
                });
            }
            return Ok(PointRule::OnCurve {
                curve,
                share: self.number(&fields.need("share")?, Measure::Plain)?,
            });
        }
        if let Some(crossing) = fields.get("crossing") {
            let [first, second]: [Item<'a>; 2] = crossing.exactly()?;
            return Ok(PointRule::Crossing {
                first: self.references(&first)?,
                second: self.references(&second)?,
            });
        }
        if let Some(base) = fields.get("foot") {
            return Ok(PointRule::Foot {
                base: self.reference(&base)?,
                line: self.references(&fields.need("in")?)?,
            });
        }
        if let Some(base) = fields.get("mirror") {
            return Ok(PointRule::Mirrored {
                base: self.reference(&base)?,
                line: self.references(&fields.need("in")?)?,
            });
        }
        let Some(from) = fields.get("from") else {
            return Err(fields.item.error(
                "the point has no place",
                "give it at, from, curve, curves, crossing, foot, mirror or mark",
            ));
        };
        let base = self.reference(&from)?;
        if let Some(offset) = fields.get("offset") {
            let [x, y] = self.lengths(&offset)?;
            return Ok(PointRule::Offset { base, x, y });
        }
        if let Some(angle) = fields.get("angle") {
            return Ok(PointRule::Polar {
                base,
                angle: self.number(&angle, Measure::Angle)?,
                distance: self.number(&fields.need("distance")?, Measure::Length)?,
            });
        }
        if let Some(toward) = fields.get("toward") {
            return Ok(PointRule::Toward {
                base,
                tip: self.reference(&toward)?,
                distance: self.number(&fields.need("distance")?, Measure::Length)?,
            });
        }
        Ok(PointRule::Between {
            base,
            tip: self.reference(&fields.need("to")?)?,
            along: self.number(&fields.need("along")?, Measure::Plain)?,
            aside: match fields.get("aside") {
                Some(aside) => self.number(&aside, Measure::Plain)?,
                None => Number::ZERO,
            },
        })
    }

    fn curve(&mut self, item: &Item<'a>) -> Result<Curve, FormatError> {
        let known = &[
            "id",
            "name",
            "from",
            "to",
            "bulge",
            "handles",
            "knots",
            "to_length",
            "mirror",
            "in",
            "copy",
        ];
        let fields = item.object(known, &mut self.notes)?;
        fields.of_one_kind(&["id", "name", "from", "to"], CURVES)?;
        let rule = if let Some(bulge) = fields.get("bulge") {
            CurveRule::Arc {
                bulge: self.number(&bulge, Measure::Plain)?,
            }
        } else if let Some(handles) = fields.get("handles") {
            let mut knots = Vec::new();
            for item in fields.items("knots")? {
                let [before, point, after] = self.references(&item)?;
                knots.push(Knot {
                    before,
                    point,
                    after,
                });
            }
            CurveRule::Spline {
                handles: self.references(&handles)?,
                knots,
                to_length: match fields.get("to_length") {
                    Some(length) => Some(self.number(&length, Measure::Length)?),
                    None => None,
                },
            }
        } else if let Some(of) = fields.get("mirror") {
            CurveRule::Mirrored {
                of: self.reference(&of)?,
                line: self.references(&fields.need("in")?)?,
            }
        } else if let Some(of) = fields.get("copy") {
            CurveRule::Copy {
                of: self.reference(&of)?,
            }
        } else {
            CurveRule::Line
        };
        Ok(Curve {
            id: self.own(&fields.need("id")?)?,
            name: fields.need("name")?.name()?.to_owned(),
            ends: [
                self.reference(&fields.need("from")?)?,
                self.reference(&fields.need("to")?)?,
            ],
            rule,
        })
    }
}
