//! Seams of version 1: shares of edges become marks on lines.

use super::document::{Number as OldNumber, Seam as OldSeam, Span as OldSpan};
use super::{Migration, Values};
use std::sync::Arc;
use toile_pattern::{LineId, Mark, Name, Number, PanelId, Seam, SeamId, Span, Want};

impl Migration<'_> {
    pub(super) fn seam(&mut self, old: &OldSeam, values: Values<'_>) {
        let id: SeamId = self.new.ids.take();
        let mut sides = [Vec::new(), Vec::new()];
        for (side, spans) in sides.iter_mut().zip(&old.sides) {
            for span in spans {
                side.push(self.span(span, values));
            }
        }
        let mut seam = Seam::new(id, old.name.clone(), sides);
        seam.ease = self.number(&old.ease);
        seam.gathered = old.gathered;
        seam.right_sides_together = old.right_sides_together;
        seam.multi_ply = old.multi_ply;
        self.new.seams.push(Arc::new(seam));
    }

    fn span(&mut self, old: &OldSpan, values: Values<'_>) -> Span {
        let half = u8::from(old.reflected);
        let Some(place) = self.edges.get(&old.edge).copied() else {
            // Named by a number that no edge has: kept, and told when it is drafted.
            let panel = self.panels.get(&old.panel).copied();
            let line: LineId = self.new.ids.take();
            return Span {
                panel: panel.unwrap_or_else(|| self.new.ids.take::<PanelId>()),
                copy: old.copy,
                half,
                line: Name::Drawn(line),
                from: Mark::corner(self.new.ids.take()),
                to: Mark::corner(self.new.ids.take()),
                backwards: false,
            };
        };
        let (from, to) = (self.number(&old.from), self.number(&old.to));
        let known = |number: &Number| number.value().or_else(|| values(number, Want::Plain));
        let (low, high) = (known(&from), known(&to));
        let backwards = matches!((low, high), (Some(low), Some(high)) if low > high);
        let same = old.from == old.to;
        let mark = |old: &OldNumber, number: Number| match old {
            OldNumber::Value(0.0) if !same => Mark::corner(place.ends[0]),
            OldNumber::Value(1.0) if !same => Mark::corner(place.ends[1]),
            _ => Mark::between(place.ends, number),
        };
        Span {
            panel: place.panel,
            copy: old.copy,
            half,
            line: Name::Drawn(place.line),
            from: mark(&old.from, from),
            to: mark(&old.to, to),
            backwards,
        }
    }
}
