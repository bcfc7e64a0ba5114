//! Garments at random: rows of panels round the body one above another, cut as pairs or on a fold at the
//! middle, drawn for either side of the wearer, and sewn right.

use std::sync::Arc;
use toile_pattern::*;

/// Repeatable randomness (SplitMix64, Steele et al. 2014).
struct Dice(u64);

impl Dice {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end as u64) as usize
    }

    fn toss(&mut self) -> bool {
        self.below(2) == 1
    }
}

/// The edges of a panel: towards the middle of the front, below, towards the middle of the back, above.
#[derive(Clone, Copy, PartialEq)]
enum Edge4 {
    Inner,
    Bottom,
    Outer,
    Top,
}

/// A panel as it is drawn and cut.
struct Drawn {
    id: PanelId,
    line: LineId,
    /// Its corners: inner top, inner bottom, outer bottom, outer top.
    corners: [PointId; 4],
    /// Whether it is drawn for the wearer's left, so that its first copy or half lies there.
    left_first: bool,
    is_folded: bool,
}

impl Drawn {
    /// A span of an edge on the wearer's left or right, from below up or from the front to the back;
    /// or against that.
    fn span(&self, edge: Edge4, left: bool, against: bool) -> Span {
        let [inner_top, inner_bottom, outer_bottom, outer_top] = self.corners;
        // Ends as walked, and whether that is against the outline of what lies on the left.
        let (ends, against_left) = match edge {
            Edge4::Inner => ([inner_bottom, inner_top], true),
            Edge4::Outer => ([outer_bottom, outer_top], false),
            Edge4::Bottom => ([inner_bottom, outer_bottom], false),
            Edge4::Top => ([inner_top, outer_top], true),
        };
        let second = left != self.left_first;
        let span = Span {
            panel: self.id,
            copy: u32::from(second && !self.is_folded),
            half: u8::from(second && self.is_folded),
            line: Name::Drawn(self.line),
            from: Mark::corner(ends[0]),
            to: Mark::corner(ends[1]),
            backwards: against_left == self.left_first,
        };
        if against { span.reversed() } else { span }
    }
}

/// A garment of rows of panels.
pub struct Stacked {
    pattern: Pattern,
    wrong: Pattern,
}

impl Stacked {
    /// The garment of a seed.
    pub fn new(seed: u64) -> Self {
        let mut dice = Dice(seed);
        let mut pattern = Pattern::default();
        let fabric = Fabric::poplin(pattern.ids.take());
        let cloth = fabric.id;
        pattern.fabrics.push(Arc::new(fabric));
        let columns = 2 + dice.below(3);
        let rows: Vec<Vec<Drawn>> = (0..1 + dice.below(3))
            .map(|row| {
                let panel = |column| {
                    let fold = match column {
                        0 if dice.toss() => Some(Edge4::Inner),
                        k if k + 1 == columns && dice.toss() => Some(Edge4::Outer),
                        _ => None,
                    };
                    let name = format!("row {row} column {column}");
                    draw(&mut pattern, cloth, &name, (fold, dice.toss()))
                };
                (0..columns).map(panel).collect()
            })
            .collect();
        let mut exchangeable = Vec::new();
        for row in &rows {
            for pair in row.windows(2) {
                let first = pattern.seams.len();
                let mut lefts = [true, false];
                if dice.toss() {
                    lefts.reverse();
                }
                for left in lefts {
                    let against = dice.toss();
                    let span = |of: &Drawn, edge| vec![of.span(edge, left, against)];
                    let sides = [span(&pair[0], Edge4::Outer), span(&pair[1], Edge4::Inner)];
                    sew(&mut pattern, &mut dice, sides);
                }
                exchangeable.push((first, [pair[0].id, pair[1].id]));
            }
            for (panel, edge) in [(&row[0], Edge4::Inner), (&row[columns - 1], Edge4::Outer)] {
                if !panel.is_folded && dice.toss() {
                    let sides = [true, false].map(|left| vec![panel.span(edge, left, false)]);
                    sew(&mut pattern, &mut dice, sides);
                }
            }
        }
        for pair in rows.windows(2) {
            sew_rows(&mut pattern, &mut dice, [&pair[0], &pair[1]]);
        }
        let mut wrong = pattern.clone();
        let (first, panels) = exchangeable[dice.below(exchangeable.len())];
        let panel = panels[dice.below(2)];
        for seam in &mut wrong.seams[first..first + 2] {
            let spans = Arc::make_mut(seam).sides.iter_mut().flatten();
            for span in spans.filter(|span| span.panel == panel) {
                let is_folded = rows
                    .iter()
                    .flatten()
                    .any(|of| of.id == panel && of.is_folded);
                match is_folded {
                    true => span.half ^= 1,
                    false => span.copy ^= 1,
                }
            }
        }
        Self { pattern, wrong }
    }

    /// The garment sewn right.
    pub fn pattern(&self) -> Pattern {
        self.pattern.clone()
    }

    /// The same with one stretch of one panel on the other copy or half in both seams that have it.
    pub fn with_one_exchange(&self) -> Pattern {
        self.wrong.clone()
    }
}

fn sew(pattern: &mut Pattern, dice: &mut Dice, mut sides: [Vec<Span>; 2]) {
    if dice.toss() {
        sides.reverse();
    }
    let id: SeamId = pattern.ids.take();
    let seam = Seam::new(id, format!("seam {}", pattern.seams.len()), sides);
    pattern.seams.push(Arc::new(seam));
}

/// Sews the bottom of a row to the top of the next: panel by panel, by halves, or all round at once.
fn sew_rows(pattern: &mut Pattern, dice: &mut Dice, rows: [&[Drawn]; 2]) {
    let edges = [Edge4::Bottom, Edge4::Top];
    let half = |left: bool, side: usize| -> Vec<Span> {
        let row = rows[side].iter();
        row.map(|panel| panel.span(edges[side], left, false))
            .collect()
    };
    match dice.below(3) {
        0 => {
            for column in rows[0].iter().zip(rows[1]) {
                let panels = [column.0, column.1];
                for left in [true, false] {
                    let sides = [0, 1].map(|k| vec![panels[k].span(edges[k], left, false)]);
                    sew(pattern, dice, sides);
                }
            }
        }
        1 => {
            for left in [true, false] {
                sew(pattern, dice, [0, 1].map(|side| half(left, side)));
            }
        }
        _ => {
            let round = |side: usize| {
                let back = half(false, side).into_iter().rev().map(Span::reversed);
                back.chain(half(true, side)).collect::<Vec<_>>()
            };
            sew(pattern, dice, [round(0), round(1)]);
        }
    }
}

/// Draws a panel and has it cut.
fn draw(
    pattern: &mut Pattern,
    fabric: FabricId,
    name: &str,
    (fold, left_first): (Option<Edge4>, bool),
) -> Drawn {
    let side = if left_first { 1.0 } else { -1.0 };
    let flare = if fold == Some(Edge4::Outer) {
        0.0
    } else {
        0.03
    };
    let places = [[0.0, 0.3], [0.0, 0.0], [0.15 + flare, 0.0], [0.15, 0.3]];
    let mut ids = pattern.ids;
    let mut drawing = PanelBuilder::new(&mut ids, name, fabric);
    let corners: Vec<PointId> = places
        .iter()
        .enumerate()
        .map(|(k, [x, y])| drawing.point(format!("p{k}"), PointRule::at(side * x, *y)))
        .collect();
    let corners = <[PointId; 4]>::try_from(corners).unwrap();
    // Counter-clockwise as drawn.
    let mut ring: Vec<PointId> = corners.to_vec();
    if !left_first {
        ring.reverse();
    }
    let edges = (0..4)
        .map(|k| {
            drawing.edge(
                format!("e{k}"),
                [ring[k], ring[(k + 1) % 4]],
                CurveRule::Line,
            )
        })
        .collect();
    let line = drawing.line("outline", LineKind::Outline, edges);
    if let Some(fold) = fold {
        let [inner_top, inner_bottom, outer_bottom, outer_top] = corners;
        let mut ends = match fold {
            Edge4::Inner => [inner_top, inner_bottom],
            _ => [outer_bottom, outer_top],
        };
        if !left_first {
            ends.reverse();
        }
        let id: OperationId = drawing.id();
        drawing.panel.operations.push(Arc::new(Operation {
            meant: false,
            id,
            name: "fold".into(),
            kind: OperationKind::Fold {
                line: Name::Drawn(line),
                ends: ends.map(Mark::corner),
            },
        }));
    } else {
        drawing.panel.cut = Cut {
            quantity: 2,
            mirrored: true,
        };
    }
    let id = drawing.panel.id;
    let made = drawing.done();
    pattern.ids = ids;
    pattern.add(made);
    Drawn {
        id,
        line,
        corners,
        left_first,
        is_folded: fold.is_some(),
    }
}
