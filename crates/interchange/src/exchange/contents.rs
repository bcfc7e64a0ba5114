//! What a document holds, by kind and number, and which of it a format has no place for.
//!
//! Every field of the document is taken apart here, and every kind of contents is decided on for every
//! format: a new field, kind or format does not compile until it is answered for.

use super::{Content, Format, Loss};
use strum::{EnumCount, VariantArray};
use toile_pattern::{
    Cut, Edge, EdgeCorner, Line, LineKind, Notch, Number, Operation, OperationKind, Panel, Pattern,
    PointRule, Seam, Sheet, Source, WornRule,
};

impl Content {
    /// Reason why a format does not carry this kind, or carries its result alone; `None`: it carries it.
    fn lost_in(self, format: Format) -> Option<&'static str> {
        match format {
            // The document is in the metadata of an SVG file.
            Format::Native | Format::Svg => None,
            Format::GarmentCode => self.lost_in_garmentcode(),
            Format::DxfAama | Format::DxfAstm => self.lost_in_dxf(),
            Format::Valentina | Format::Seamly => Some("the format is not written"),
        }
    }

    fn lost_in_dxf(self) -> Option<&'static str> {
        /// The format has no field for it.
        const NO_PLACE: Option<&str> = Some("the format has no place for them");
        match self {
            Self::Panels
            | Self::InternalLines
            | Self::Holes
            | Self::Notches
            | Self::Grains
            | Self::Copies => None,
            Self::Sizes => Some("written as shapes, without their measurements"),
            Self::Variables | Self::Guides | Self::Places | Self::Seams | Self::Eases => NO_PLACE,
            Self::Markers | Self::Fitting => NO_PLACE,
            Self::Fabrics => Some("written by their names alone"),
            Self::Formulas | Self::Constructions => Some("written as drafted"),
            Self::Darts
            | Self::Spreads
            | Self::Splits
            | Self::Pleats
            | Self::InsertedLines
            | Self::Operations => Some("written as drafted"),
            Self::Folds => Some("written unfolded"),
            Self::Allowances => Some("written as cut and sew lines"),
            Self::Corners => Some("written as the cut line that they give"),
        }
    }

    fn lost_in_garmentcode(self) -> Option<&'static str> {
        /// The format has no field for it.
        const NO_PLACE: Option<&str> = Some("the format has no place for them");
        /// The shape that it gives is written.
        const AS_DRAFTED: Option<&str> = Some("written as drafted, in one size");
        match self {
            Self::Panels | Self::Seams | Self::Places => None,
            Self::Holes => Some("written as further edge loops, which other readers may not know"),
            Self::Sizes
            | Self::Variables
            | Self::Fabrics
            | Self::Guides
            | Self::InternalLines
            | Self::InsertedLines
            | Self::Notches
            | Self::Allowances
            | Self::Corners
            | Self::Grains
            | Self::Markers
            | Self::Fitting => NO_PLACE,
            Self::Formulas | Self::Constructions => AS_DRAFTED,
            Self::Darts => Some("written as edges that are sewn together"),
            Self::Folds => Some("written unfolded"),
            Self::Spreads | Self::Splits | Self::Pleats | Self::Operations => AS_DRAFTED,
            Self::Copies => Some("written as panels of their own"),
            Self::Eases => Some("kept as the lengths of both sides alone"),
        }
    }
}

/// Reason why a format does not carry a kind of contents, or carries its result alone; `None`: it carries it.
pub(super) fn lost_in(content: Content, format: Format) -> Option<&'static str> {
    content.lost_in(format)
}

/// The contents of a pattern that a format has no place for, in the order of their kinds.
pub(super) fn losses(pattern: &Pattern, format: Format) -> Vec<Loss> {
    let counts = counted(pattern);
    let all = Content::VARIANTS.iter().zip(counts);
    let lost = all.filter_map(|(&content, count)| {
        let why = content.lost_in(format).filter(|_| count > 0)?;
        Some(Loss::of(content, count, why))
    });
    lost.collect()
}

/// The contents of a pattern: every kind that it has, with the number of these.
pub fn contents(pattern: &Pattern) -> Vec<(Content, usize)> {
    let all = Content::VARIANTS.iter().copied().zip(counted(pattern));
    all.filter(|(_, count)| *count > 0).collect()
}

/// Number of contents of each kind, in the order of the kinds.
fn counted(pattern: &Pattern) -> [usize; Content::COUNT] {
    let mut counter = Counter([0; Content::COUNT]);
    counter.pattern(pattern);
    counter.0
}

struct Counter([usize; Content::COUNT]);

impl Counter {
    fn add(&mut self, content: Content, count: usize) {
        self.0[content as usize] += count;
    }

    fn add_if(&mut self, content: Content, is_there: bool) {
        self.add(content, usize::from(is_there));
    }

    fn pattern(&mut self, pattern: &Pattern) {
        let Pattern {
            name: _,
            unit: _,
            sizes,
            base_size: _,
            variables,
            fabrics,
            sheets,
            panels,
            seams,
            markers,
            guides,
            ids: _,
        } = pattern;
        self.add(Content::Sizes, sizes.len());
        self.add(Content::Variables, variables.len());
        self.add(Content::Fabrics, fabrics.len());
        self.add(Content::Markers, markers.len());
        self.add(Content::Guides, guides.len());
        let numbers = toile_pattern::fields::numbers(pattern);
        let formulas = numbers.into_iter().filter(|number| !is_value(number));
        self.add(Content::Formulas, formulas.count());
        sheets.iter().for_each(|sheet| self.sheet(sheet));
        panels.iter().for_each(|panel| self.panel(panel));
        seams.iter().for_each(|seam| self.seam(seam));
    }

    fn sheet(&mut self, sheet: &Sheet) {
        let Sheet {
            id: _,
            name: _,
            on: _,
            on_table: _,
            points,
            curves: _,
        } = sheet;
        let constructed = points
            .iter()
            .filter(|point| !matches!(point.rule, PointRule::At { .. }));
        self.add(Content::Constructions, constructed.count());
    }

    fn panel(&mut self, panel: &Panel) {
        let Panel {
            id: _,
            name: _,
            source,
            lines,
            notches,
            operations,
            grain,
            allowance,
            cut: Cut {
                quantity,
                mirrored: _,
            },
            fabric: _,
            worn,
            on_table: _,
        } = panel;
        self.add(Content::Panels, 1);
        self.add_if(Content::Splits, matches!(source, Source::Side { .. }));
        self.add_if(Content::Copies, *quantity != 1);
        self.add_if(Content::Places, *worn != WornRule::Automatic);
        let upright = Number::Value(std::f64::consts::FRAC_PI_2);
        self.add_if(Content::Grains, *grain != upright);
        self.add_if(Content::Allowances, *allowance != Number::ZERO);
        lines.iter().for_each(|line| self.line(line));
        for notch in notches {
            let Notch {
                id: _,
                name: _,
                line: _,
                at: _,
                kind: _,
            } = notch;
            self.add(Content::Notches, 1);
        }
        operations
            .iter()
            .for_each(|operation| self.operation(operation));
    }

    fn line(&mut self, line: &Line) {
        let Line {
            id: _,
            name: _,
            kind,
            by: _,
            edges,
        } = line;
        self.add_if(Content::Holes, *kind == LineKind::Hole);
        self.add_if(Content::InternalLines, *kind == LineKind::Internal);
        for edge in edges {
            let Edge {
                id: _,
                name: _,
                curve: _,
                ends: _,
                allowance,
                corner,
            } = edge;
            self.add_if(Content::Allowances, allowance.is_some());
            self.add_if(Content::Corners, *corner != EdgeCorner::default());
        }
    }

    fn operation(&mut self, operation: &Operation) {
        type Kind = OperationKind;
        let kind = &operation.kind;
        let named: &[(bool, Content)] = &[
            (
                matches!(
                    kind,
                    Kind::Dart { .. } | Kind::Diamond { .. } | Kind::Pivot { .. }
                ),
                Content::Darts,
            ),
            (matches!(kind, Kind::Fold { .. }), Content::Folds),
            (matches!(kind, Kind::Spread { .. }), Content::Spreads),
            (matches!(kind, Kind::Split { .. }), Content::Splits),
            (matches!(kind, Kind::Insert { .. }), Content::InsertedLines),
            (matches!(kind, Kind::Pleat { .. }), Content::Pleats),
        ];
        let own = named.iter().find(|(is_own, _)| *is_own);
        let content = own.map_or(Content::Operations, |(_, content)| *content);
        self.add(content, 1);
    }

    fn seam(&mut self, seam: &Seam) {
        let Seam {
            id: _,
            name: _,
            sides: _,
            ease,
            gathered,
            right_sides_together: _,
            multi_ply: _,
        } = seam;
        self.add(Content::Seams, 1);
        self.add_if(Content::Eases, *gathered || *ease != Number::ZERO);
    }
}

fn is_value(number: &Number) -> bool {
    match number {
        Number::Value(_) => true,
        Number::Formula(_) | Number::Adjusted { .. } | Number::PerSize { .. } => false,
    }
}
