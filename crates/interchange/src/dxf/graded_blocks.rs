//! Blocks of a sample size graded by a rule table: each rule moves the vertices that its number stands at, and
//! vertices between two of them by the length of the line.

use super::block_piece::{BlockLine, BlockPiece};
use super::rule_table::RuleTable;
use crate::drawn::allowance::nearest;
use crate::{FormatError, Guess, Loss, ReadOption};
use std::collections::BTreeSet;
use toile_geometry::Vec2;

/// A table of grade rules, and how it belongs to a drawing.
pub(super) struct Grading<'t> {
    pub table: &'t RuleTable,
    /// Name of the table's file.
    pub file: &'t str,
    /// Units of the drawing in a unit of the table.
    pub scale: f64,
    /// Largest distance of a number from the vertex that it grades (units of the drawing).
    pub reach: f64,
    /// Size of the drawing's blocks, if the style says it.
    pub drawn_size: Option<String>,
}

/// Blocks in all sizes, and what grading found out.
pub(super) struct GradedBlocks {
    /// The blocks of all sizes.
    pub pieces: Vec<BlockPiece>,
    /// Name of the size that was drawn.
    pub base: String,
    /// The rules by size against the size that was drawn (units of the drawing).
    pub rules: Vec<(u32, Vec<Vec2>)>,
    pub guesses: Vec<Guess>,
    pub losses: Vec<Loss>,
}

/// The shifts of a vertex in all sizes (units of the drawing).
type Shifts = Vec<Vec2>;

/// Grades the blocks of one size.
///
/// # Errors
/// The size of the blocks is none of the table's.
pub(super) fn graded(
    pieces: Vec<BlockPiece>,
    grading: &Grading<'_>,
) -> Result<GradedBlocks, FormatError> {
    let table = grading.table;
    let own = pieces.iter().find_map(BlockPiece::size);
    let own = own.or_else(|| grading.drawn_size.clone());
    let mut guesses = Vec::new();
    let base = match &own {
        Some(name) => table.sizes.iter().position(|size| size == name),
        None => {
            guesses.push(Guess {
                what: "size",
                chosen: table.sizes[table.sample].clone(),
                because: "the pieces name no size, and it is the sample size of the rule table"
                    .to_owned(),
                option: ReadOption::With,
            });
            Some(table.sample)
        }
    };
    let Some(base) = base else {
        return Err(FormatError::new(
            format!("the rule table {}", grading.file),
            format!(
                "its sizes are {}, and the pieces are drawn in size {}",
                table.sizes.join(", "),
                own.unwrap_or_default()
            ),
            "give the table of this pattern with --with, or take this one out of the folder",
        ));
    };
    let rules = table.rules.iter().map(|(&number, shifts)| {
        let own = shifts.iter().map(|by| (by - shifts[base]) * grading.scale);
        (number, own.collect::<Shifts>())
    });
    let mut grader = Grader {
        grading,
        base,
        rules: rules.collect(),
        losses: Vec::new(),
        between: 0,
        followed: 0,
    };
    let mut all = Vec::with_capacity(pieces.len() * table.sizes.len());
    for piece in &pieces {
        all.extend(grader.piece(piece));
    }
    if grader.between > 0 {
        guesses.push(Guess {
            what: "points between grade rules",
            chosen: "moved by their share of the length between".to_owned(),
            because: format!(
                "{} vertices have no rule and the file has no blocks of other sizes; this is 0.2 mm off in \
                 the middle of real files, and more in one of ten",
                grader.between
            ),
            option: ReadOption::With,
        });
    }
    if grader.followed > 0 {
        grader.losses.push(Loss {
            count: grader.followed,
            ..Loss::at(
                "",
                "grading of lines without rules",
                "they move like the nearest place of the outline",
            )
        });
    }
    Ok(GradedBlocks {
        pieces: all,
        base: table.sizes[base].clone(),
        rules: grader.rules,
        guesses,
        losses: grader.losses,
    })
}

struct Grader<'t> {
    grading: &'t Grading<'t>,
    base: usize,
    /// The rules against the size that was drawn (units of the drawing).
    rules: Vec<(u32, Shifts)>,
    losses: Vec<Loss>,
    /// Number of vertices that were moved by their share of a length.
    between: usize,
    /// Number of lines that were moved like the outline.
    followed: usize,
}

/// The lines of one kind of a piece.
type LinesOf<'f> = &'f dyn Fn(&mut BlockPiece) -> &mut Vec<BlockLine>;

impl Grader<'_> {
    /// A piece in all sizes.
    fn piece(&mut self, piece: &BlockPiece) -> Vec<BlockPiece> {
        let sizes = &self.grading.table.sizes;
        let sized = |size: &String| {
            let mut own = piece.clone();
            own.labels.set("size", size);
            own
        };
        let mut all: Vec<BlockPiece> = sizes.iter().map(sized).collect();
        let marks = self.marks(piece);
        let Some(cut) = piece.cut.first() else {
            return all;
        };
        let Some(outline) = self.shifts(cut, &marks) else {
            self.losses.push(Loss::at(
                piece.label().unwrap_or(&piece.block),
                "grading",
                "no grade rule stands at its outline: it is alike in all sizes",
            ));
            return all;
        };
        let near = |at: Vec2| -> Option<Shifts> {
            let found = nearest(at, &cut.points)?;
            let next = (found.chord + 1) % cut.points.len();
            let ends = outline[found.chord].iter().zip(&outline[next]);
            Some(ends.map(|(a, b)| a + (b - a) * found.share).collect())
        };
        let ruled = |at: Vec2| -> Option<Shifts> {
            let near = marks
                .iter()
                .filter(|(place, _)| (place - at).norm() <= self.grading.reach);
            let closest = near.min_by(|a, b| (a.0 - at).norm().total_cmp(&(b.0 - at).norm()));
            closest.map(|(_, shifts)| shifts.clone())
        };
        for (k, own) in all.iter_mut().enumerate() {
            own.rules.clear();
            own.axes.clear();
            // Dense twins are those of the size that is drawn alone: curves go through the vertices in all sizes.
            own.twins.clear();
            // Corners are told by the block of the sample size alone.
            if k != self.base {
                own.turn_points.clear();
            }
        }
        let mut put = |lines: LinesOf<'_>, number: usize, shifts: &[Shifts]| {
            for (size, own) in all.iter_mut().enumerate() {
                if let Some(line) = lines(own).get_mut(number) {
                    let moved = line.points.iter_mut().zip(shifts);
                    moved.for_each(|(p, by)| *p += by[size]);
                    // Points of a curve between two vertices follow both.
                    for (k, points) in line.between.iter_mut().enumerate() {
                        let [a, b] = [k, k + 1].map(|k| shifts[k % shifts.len()][size]);
                        let parts = (points.len() + 1) as f64;
                        for (j, p) in points.iter_mut().enumerate() {
                            *p += a + (b - a) * ((j + 1) as f64 / parts);
                        }
                    }
                }
            }
        };
        put(&|own| &mut own.cut, 0, &outline);
        let kinds: [(LinesOf<'_>, &[BlockLine]); 5] = [
            (&|own| &mut own.sew, &piece.sew),
            (&|own| &mut own.internal, &piece.internal),
            (&|own| &mut own.cutouts, &piece.cutouts),
            (&|own| &mut own.mirror, &piece.mirror),
            (&|own| &mut own.grain, &piece.grain),
        ];
        for (kind, (lines, drawn)) in kinds.into_iter().enumerate() {
            for (number, line) in drawn.iter().enumerate() {
                let shifts = match self.shifts(line, &marks) {
                    Some(shifts) => shifts,
                    None => {
                        // Grain and fold lines have no rules of their own in any file.
                        self.followed += usize::from(kind < 3);
                        let moved = line.points.iter().map(|&at| near(at).unwrap_or_default());
                        moved.collect()
                    }
                };
                if shifts
                    .iter()
                    .all(|by| by.len() == self.grading.table.sizes.len())
                {
                    put(lines, number, &shifts);
                }
            }
        }
        for (number, &(at, _)) in piece.notches.iter().enumerate() {
            if let Some(shifts) = ruled(at).or_else(|| near(at)) {
                for (size, own) in all.iter_mut().enumerate() {
                    own.notches[number].0 += shifts[size];
                }
            }
        }
        for (number, (line, _)) in piece.notch_lines.iter().enumerate() {
            let first = line.points.first();
            let shifts = first.and_then(|&at| ruled(at).or_else(|| near(at)));
            let Some(shifts) = shifts else { continue };
            for (size, own) in all.iter_mut().enumerate() {
                let points = own.notch_lines[number].0.points.iter_mut();
                points.for_each(|p| *p += shifts[size]);
            }
        }
        for (number, &at) in piece.drills.iter().enumerate() {
            if let Some(shifts) = ruled(at).or_else(|| near(at)) {
                for (size, own) in all.iter_mut().enumerate() {
                    own.drills[number] += shifts[size];
                }
            }
        }
        all
    }

    /// The places that rules stand at in a piece, with their shifts along the axes of the sheet; numbers that the
    /// table lacks are told.
    fn marks(&mut self, piece: &BlockPiece) -> Vec<(Vec2, Shifts)> {
        let along = piece.axes.iter().find_map(|line| {
            let way = *line.points.last()? - *line.points.first()?;
            way.try_normalize(1e-9)
        });
        let along = along.unwrap_or(Vec2::x());
        let left = Vec2::new(-along.y, along.x);
        let mut missing: BTreeSet<u32> = BTreeSet::new();
        let mut marks: Vec<(Vec2, Shifts)> = Vec::new();
        for (at, number) in &piece.rules {
            match self.rules.binary_search_by_key(number, |(known, _)| *known) {
                Ok(k) => {
                    let turned = self.rules[k].1.iter().map(|by| along * by.x + left * by.y);
                    marks.push((*at, turned.collect()));
                }
                Err(_) => {
                    missing.insert(*number);
                }
            }
        }
        if !missing.is_empty() {
            let numbers: Vec<String> = missing.iter().map(u32::to_string).collect();
            self.losses.push(Loss {
                count: missing.len(),
                ..Loss::at(
                    piece.label().unwrap_or(&piece.block),
                    format!("grade rules {}", numbers.join(", ")),
                    format!("{} has none of these numbers", self.grading.file),
                )
            });
        }
        marks
    }

    /// The shifts of the vertices of a line: of rules, and between them by length. `None`: no rule stands at it.
    fn shifts(&mut self, line: &BlockLine, marks: &[(Vec2, Shifts)]) -> Option<Vec<Shifts>> {
        let count = line.points.len();
        let mut ruled: Vec<Option<&Shifts>> = vec![None; count];
        for (at, shifts) in marks {
            let off = |k: &usize| (line.points[*k] - at).norm();
            let best = (0..count).min_by(|a, b| off(a).total_cmp(&off(b)));
            let Some(best) = best.filter(|k| off(k) <= self.grading.reach) else {
                continue;
            };
            // A closed line may repeat its start: all vertices there have the rule.
            let place = line.points[best];
            for k in (0..count).filter(|&k| line.points[k] == place) {
                ruled[k].get_or_insert(shifts);
            }
        }
        let known: Vec<usize> = (0..count).filter(|&k| ruled[k].is_some()).collect();
        let (&first, &last) = (known.first()?, known.last()?);
        self.between += count - known.len();
        let mut along = vec![0.0; count + 1];
        for k in 0..count {
            let next = line.points[(k + 1) % count];
            along[k + 1] = along[k] + (next - line.points[k]).norm();
        }
        let whole = along[count];
        let of = |k: usize| -> Shifts {
            if let Some(shifts) = ruled[k] {
                return shifts.clone();
            }
            let next = known.partition_point(|&known| known < k);
            let before = next.checked_sub(1).map(|before| &known[before]);
            let after = known.get(next);
            let (from, to) = match (before, after, line.is_closed) {
                (Some(&from), Some(&to), _) => (from, to),
                (_, _, true) => (last, first),
                (Some(&only), None, false) | (None, Some(&only), false) => (only, only),
                (None, None, false) => (first, first),
            };
            let around = |length: f64| if length < 0.0 { length + whole } else { length };
            let part = around(along[k] - along[from]);
            let all = around(along[to] - along[from]);
            let share = if all > 0.0 { part / all } else { 0.0 };
            let ends = ruled[from]
                .into_iter()
                .flatten()
                .zip(ruled[to].into_iter().flatten());
            ends.map(|(a, b)| a + (b - a) * share).collect()
        };
        Some((0..count).map(of).collect())
    }
}
