//! Seams: which edges of panels are sewn to which.
//!
//! # Decided with
//! - [`crate::plan::sew`], [`crate::plan::numbers_of`]: seams sewn; their numbers in the window;
//! - [`crate::evaluate`] (`seams.rs`, `seam`, `locate`): spans, lengths of both sides, ease;
//! - [`crate::drafting`] (`seams`): seams of the draft, gathers, eases;
//! - [`crate::check`] (`check_seam`), [`crate::check::SEAM_TOLERANCE`]: sides that differ too much, negative ease;
//! - [`crate::walk`], [`crate::plan::opposites`]: places opposite each other, in proportion.
//!
//! On the cloth: crate `assembly`, `sampling.rs` (`link_intervals`, `gathered_intervals`). From files: crate
//! `interchange`, `garmentcode/reader.rs`. Seams in a heap: crate `session`, `crumple.rs`.

use crate::fields::{ValueField, group, key, length};
use crate::{LineName, Mark, Number, PanelId, SeamId, fields};
use serde::{Deserialize, Serialize};

/// Two chains of spans that are sewn together, beginning at the start of each chain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seam {
    /// Identifier of the seam.
    pub id: SeamId,
    /// Name to show.
    pub name: String,
    /// Spans of both sides, each in walking order.
    pub sides: [Vec<Span>; 2],
    /// Length by which one side may be longer than the other (m).
    pub ease: Number,
    /// Whether the longer side is gathered to fit the shorter side, whatever its length.
    pub gathered: bool,
    /// Whether the right sides lie together during sewing: the usual seam.
    pub right_sides_together: bool,
    /// Whether more than two plies may meet at this seam.
    pub multi_ply: bool,
}

impl Default for Seam {
    fn default() -> Self {
        Self::new(SeamId::default(), "", [Vec::new(), Vec::new()])
    }
}

fields!(Seam, |self, v| {
    let Self {
        id,
        name,
        sides: [first, second],
        ease,
        gathered,
        right_sides_together,
        multi_ply,
    } = self;
    v.own(id);
    v.value(ValueField::NAME, name);
    v.list(group("sides"), &mut |v| {
        v.each(group("first"), first);
        v.each(group("second"), second);
    });
    v.number(length("ease").left_out_at(0.0).shown_first(), ease);
    v.value(key("gathered").left_out_if(!*gathered), gathered);
    v.value(
        key("right_sides_together").left_out_if(*right_sides_together),
        right_sides_together,
    );
    v.value(key("multi_ply").left_out_if(!*multi_ply), multi_ply);
});

impl Seam {
    /// A seam without ease, right sides together.
    pub fn new(id: SeamId, name: impl Into<String>, sides: [Vec<Span>; 2]) -> Self {
        Self {
            id,
            name: name.into(),
            sides,
            ease: Number::ZERO,
            gathered: false,
            right_sides_together: true,
            multi_ply: false,
        }
    }

    /// The spans of both sides.
    pub fn spans(&self) -> impl Iterator<Item = &Span> {
        self.sides.iter().flatten()
    }
}

/// A stretch of a line on one copy of a panel.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Span {
    /// The panel.
    pub panel: PanelId,
    /// Number of the copy, from 0.
    pub copy: u32,
    /// Half of a folded panel: 0 is the half as drawn; each fold has one bit, which is set for the half
    /// beyond that fold.
    pub half: u8,
    /// The line that the stretch is on.
    pub line: LineName,
    /// Start of the span.
    pub from: Mark,
    /// End of the span.
    pub to: Mark,
    /// Whether the span is walked against the line.
    pub backwards: bool,
}

fields!(Span, |self, v| {
    let Self {
        panel,
        copy,
        half,
        line,
        from,
        to,
        backwards,
    } = self;
    v.id("panel", panel);
    v.part(group("line"), line);
    v.mark(group("from").label("start"), from);
    v.mark(group("to").label("end"), to);
    v.value(key("copy").left_out_if(*copy == 0), copy);
    let halves = key("half").beyond("there are not that many halves", "write 0 or 1");
    v.value(halves.left_out_if(*half == 0), half);
    v.value(key("backwards").left_out_if(!*backwards), backwards);
});

impl Span {
    /// This span walked the other way.
    pub fn reversed(self) -> Self {
        Self {
            from: self.to,
            to: self.from,
            backwards: !self.backwards,
            ..self
        }
    }
}
