//! Replaces ids in copied parts and in all references among them.

use crate::{
    Apex, CornerName, CurveRule, Entity, Mark, Name, Number, OperationKind, Panel, PartId,
    PartReference, PointRule, SizeId, Source, Span, Token, WornRule,
};
use std::collections::HashMap;
use std::sync::Arc;

/// From old ids to new ones. Ids it does not know stay.
#[derive(Default)]
pub(super) struct Remap {
    pub ids: HashMap<PartId, PartId>,
    /// Of each size, the one that stands for it; values of sizes that are not here are dropped.
    pub sizes: HashMap<SizeId, SizeId>,
}

impl Remap {
    /// The id that stands for one.
    pub fn id<T: Copy + Into<PartId> + From<u32>>(&self, id: T) -> T {
        let found = self.ids.get(&id.into());
        found.map_or(id, |part| T::from(part.number()))
    }

    fn name<T: Copy + Into<PartId> + From<u32>>(&self, name: Name<T>) -> Name<T> {
        match name {
            Name::Drawn(id) => Name::Drawn(self.id(id)),
            Name::Made { by, role, index } => Name::Made {
                by: self.id(by),
                role,
                index,
            },
        }
    }

    /// The entity with all ids changed, its own too.
    pub fn entity(&self, entity: Entity) -> Entity {
        match entity {
            // Fragments have no markers and no guides.
            Entity::Head(_) | Entity::Size(_) | Entity::Marker(_) | Entity::Guide(_) => entity,
            Entity::Fabric(mut fabric) => {
                let own = Arc::make_mut(&mut fabric);
                own.id = self.id(own.id);
                Entity::Fabric(fabric)
            }
            Entity::Variable(mut variable) => {
                let own = Arc::make_mut(&mut variable);
                own.id = self.id(own.id);
                self.number(&mut own.number);
                Entity::Variable(variable)
            }
            Entity::Sheet(mut head) => {
                head.id = self.id(head.id);
                let on =
                    |(panel, after): (_, Option<_>)| (self.id(panel), after.map(|o| self.id(o)));
                head.on = head.on.map(on);
                Entity::Sheet(head)
            }
            Entity::Point(sheet, mut point) => {
                let own = Arc::make_mut(&mut point);
                own.id = self.id(own.id);
                self.point_rule(&mut own.rule);
                Entity::Point(self.id(sheet), point)
            }
            Entity::Curve(sheet, mut curve) => {
                let own = Arc::make_mut(&mut curve);
                own.id = self.id(own.id);
                own.ends = own.ends.map(|end| self.id(end));
                self.curve_rule(&mut own.rule);
                Entity::Curve(self.id(sheet), curve)
            }
            Entity::Panel(mut panel) => {
                self.panel(Arc::make_mut(&mut panel));
                Entity::Panel(panel)
            }
            Entity::Seam(mut seam) => {
                let own = Arc::make_mut(&mut seam);
                own.id = self.id(own.id);
                self.number(&mut own.ease);
                own.sides.iter_mut().flatten().for_each(|s| self.span(s));
                Entity::Seam(seam)
            }
        }
    }

    fn number(&self, number: &mut Number) {
        match number {
            Number::Value(_) => {}
            Number::Formula(formula) | Number::Adjusted { formula, .. } => {
                *formula = formula.mapped(&mut |token| self.token(token));
            }
            Number::PerSize { usual, sizes } => {
                self.number(usual);
                let own = |(size, value): &(SizeId, f64)| Some((*self.sizes.get(size)?, *value));
                *sizes = sizes.iter().filter_map(own).collect();
            }
        }
    }

    fn token(&self, token: &Token) -> Token {
        match token {
            Token::Text(_) | Token::Word(_) => token.clone(),
            Token::Variable(id) => Token::Variable(self.id(*id)),
            Token::Part(part) => Token::Part(match part {
                PartReference::Point(id) => PartReference::Point(self.id(*id)),
                PartReference::Curve(id) => PartReference::Curve(self.id(*id)),
                PartReference::Seam(id) => PartReference::Seam(self.id(*id)),
                PartReference::Stretch { panel, ends } => PartReference::Stretch {
                    panel: self.id(*panel),
                    ends: ends.map(|end: CornerName| self.name(end)),
                },
                PartReference::Unknown(_) => part.clone(),
            }),
        }
    }

    fn point_rule(&self, rule: &mut PointRule) {
        let pair = |pair: &mut [_; 2]| *pair = pair.map(|id| self.id(id));
        match rule {
            PointRule::At { x, y } => {
                self.number(x);
                self.number(y);
            }
            PointRule::Offset { base, x, y } => {
                *base = self.id(*base);
                self.number(x);
                self.number(y);
            }
            PointRule::Polar {
                base,
                angle,
                distance,
            } => {
                *base = self.id(*base);
                self.number(angle);
                self.number(distance);
            }
            PointRule::Between {
                base,
                tip,
                along,
                aside,
            } => {
                (*base, *tip) = (self.id(*base), self.id(*tip));
                self.number(along);
                self.number(aside);
            }
            PointRule::Toward {
                base,
                tip,
                distance,
            } => {
                (*base, *tip) = (self.id(*base), self.id(*tip));
                self.number(distance);
            }
            PointRule::OnCurve { curve, share } => {
                *curve = self.id(*curve);
                self.number(share);
            }
            PointRule::AlongCurve { curve, distance } => {
                *curve = self.id(*curve);
                self.number(distance);
            }
            PointRule::Crossing { first, second } => {
                pair(first);
                pair(second);
            }
            PointRule::CurveCrossing { curves, .. } => {
                *curves = curves.map(|id| self.id(id));
            }
            PointRule::LineCrossing { line, curve, .. } => {
                pair(line);
                *curve = self.id(*curve);
            }
            PointRule::Mark { line, at } => {
                *line = self.name(*line);
                self.mark(at);
            }
            PointRule::Foot { base, line } | PointRule::Mirrored { base, line } => {
                *base = self.id(*base);
                pair(line);
            }
        }
    }

    fn curve_rule(&self, rule: &mut CurveRule) {
        match rule {
            CurveRule::Line => {}
            CurveRule::Arc { bulge } => self.number(bulge),
            CurveRule::Spline {
                handles,
                knots,
                to_length,
            } => {
                *handles = handles.map(|id| self.id(id));
                for knot in knots {
                    knot.before = self.id(knot.before);
                    knot.point = self.id(knot.point);
                    knot.after = self.id(knot.after);
                }
                if let Some(length) = to_length {
                    self.number(length);
                }
            }
            CurveRule::Mirrored { of, line } => {
                *of = self.id(*of);
                *line = line.map(|id| self.id(id));
            }
            CurveRule::Copy { of } => *of = self.id(*of),
        }
    }

    fn mark(&self, mark: &mut Mark) {
        match mark {
            Mark::Corner(corner) => *corner = self.name(*corner),
            Mark::Notch(id) => *id = self.id(*id),
            Mark::Along { from, distance } => {
                *from = self.name(*from);
                self.number(distance);
            }
            Mark::Between { ends, share } => {
                *ends = ends.map(|end| self.name(end));
                self.number(share);
            }
        }
    }

    fn span(&self, span: &mut Span) {
        span.panel = self.id(span.panel);
        span.line = self.name(span.line);
        self.mark(&mut span.from);
        self.mark(&mut span.to);
    }

    fn operation(&self, kind: &mut OperationKind) {
        match kind {
            OperationKind::Dart {
                line,
                mouth,
                intake,
                apex,
                pressed: _,
                trued: _,
                keeps_length: _,
            } => {
                *line = self.name(*line);
                self.mark(mouth);
                self.number(intake);
                match apex {
                    Apex::Depth(depth) => self.number(depth),
                    Apex::Point(point) => *point = self.id(*point),
                }
            }
            OperationKind::Diamond {
                ends,
                widest,
                intake,
            } => {
                *ends = ends.map(|id| self.id(id));
                self.number(widest);
                self.number(intake);
            }
            OperationKind::Fold { line, ends } => {
                *line = self.name(*line);
                ends.iter_mut().for_each(|end| self.mark(end));
            }
            OperationKind::Pivot {
                dart,
                line,
                mouth,
                share,
                back,
                turned: _,
                pressed: _,
            } => {
                *dart = self.id(*dart);
                *line = self.name(*line);
                self.mark(mouth);
                self.number(share);
                self.number(back);
            }
            OperationKind::Split { line, curve } => {
                *line = self.name(*line);
                *curve = self.id(*curve);
            }
            OperationKind::Pleat {
                line,
                held,
                pleats,
                depth,
                kind: _,
                pressed: _,
                trued: _,
            } => {
                *line = self.name(*line);
                self.mark(held);
                for pleat in pleats {
                    pleat.ends.iter_mut().for_each(|end| self.mark(end));
                }
                self.number(depth);
            }
            OperationKind::Insert { sheet } => *sheet = self.id(*sheet),
            OperationKind::Spread {
                line,
                held,
                cuts,
                bridge: _,
            } => {
                *line = self.name(*line);
                self.mark(held);
                for cut in cuts {
                    cut.ends.iter_mut().for_each(|end| self.mark(end));
                    cut.openings.iter_mut().for_each(|n| self.number(n));
                }
            }
        }
    }

    fn panel(&self, panel: &mut Panel) {
        panel.id = self.id(panel.id);
        match &mut panel.source {
            Source::Traced(sheet) => *sheet = self.id(*sheet),
            Source::Side { of, split, side: _ } => {
                *of = self.id(*of);
                *split = self.id(*split);
            }
        }
        panel.fabric = self.id(panel.fabric);
        self.number(&mut panel.grain);
        self.number(&mut panel.allowance);
        for line in &mut panel.lines {
            line.id = self.id(line.id);
            line.by = line.by.map(|by| self.id(by));
            for edge in &mut line.edges {
                edge.id = self.id(edge.id);
                edge.curve = self.id(edge.curve);
                edge.ends = edge.ends.map(|end| self.id(end));
                if let Some(allowance) = &mut edge.allowance {
                    self.number(allowance);
                }
            }
        }
        for notch in &mut panel.notches {
            notch.id = self.id(notch.id);
            notch.line = self.id(notch.line);
            self.mark(&mut notch.at);
        }
        for operation in &mut panel.operations {
            let operation = Arc::make_mut(operation);
            operation.id = self.id(operation.id);
            self.operation(&mut operation.kind);
        }
        if let WornRule::Wrapped {
            level: Some(level), ..
        } = &mut panel.worn
        {
            self.number(level);
        }
    }
}
