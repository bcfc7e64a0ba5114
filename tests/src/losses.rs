//! Random deletions and changes of count in the patterns that ship: one diagnostic a cause, what is
//! lost is suspended and returns with undo, and the journal replayed gives the same document.

use crate::random::Random;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toile_interchange::write_pattern;
use toile_pattern::{
    Code, Diagnostic, Draft, Edit, EditError, Entity, Evaluation, Panel, PartId, Pattern, Place,
    SeamOrigin, Severity, plan,
};
use toile_session::{Command, Event, SAMPLES, Session, Silent};

/// Changes of one run.
pub const CHANGES: usize = 10;
/// The counter of ids in files that are compared: beyond any that is given here.
const COUNTED: u32 = 1_000_000;
/// Most times a panel is cut.
const MAX_CUT: usize = 4;

/// What a state of the document comes to. The counter of ids, which an undo does not set back, is
/// left out of the file.
struct State {
    pattern: Arc<Pattern>,
    file: String,
    draft: Arc<Draft>,
    found: Arc<Vec<Diagnostic>>,
}

impl State {
    fn of(session: &mut Session) -> Result<Self, String> {
        let pattern = session.project().pattern.clone();
        let mut counted = (*pattern).clone();
        counted.ids.next = COUNTED;
        Ok(Self {
            file: write_pattern(&counted).map_err(|error| error.to_string())?,
            draft: session.draft(),
            found: session.diagnostics(),
            pattern,
        })
    }

    /// Why it is not the other; nothing if they are the same.
    fn differs(&self, other: &Self) -> Option<&'static str> {
        if !self.pattern.says_the_same(&other.pattern) {
            Some("document")
        } else if self.file != other.file {
            Some("file")
        } else if self.draft != other.draft {
            Some("draft")
        } else if self.found != other.found {
            Some("findings")
        } else {
            None
        }
    }

    fn same(&self, other: &Self, when: &str) -> Result<(), String> {
        match self.differs(other) {
            Some(what) => Err(format!("{when}: the {what} is another")),
            None => Ok(()),
        }
    }
}

fn run(session: &mut Session, command: Command) -> Result<Vec<Event>, String> {
    let done = session.execute(command, &mut Silent);
    done.map_err(|error| error.to_string())
}

/// [`CHANGES`] changes of one pattern by a seed, each undone and done again, then all undone; the
/// journal is replayed into a folder.
///
/// # Errors
/// What does not hold, with the seed and the change.
pub fn losses(seed: u64, folder: &Path) -> Result<(), String> {
    let mut random = Random(seed);
    let (path, name) = SAMPLES[seed as usize % SAMPLES.len()];
    let mut session = Session::new();
    let path = PathBuf::from(path);
    run(&mut session, Command::open(path))?;
    let first = State::of(&mut session)?;
    let mut done = 0;
    while done < CHANGES {
        let before = State::of(&mut session)?;
        let edits = match changes(&session.evaluation(), &mut random) {
            Ok(edits) if edits.is_empty() => continue,
            Ok(edits) => edits,
            Err(refused) if refused.to_string().contains(": ") => continue,
            Err(refused) => return Err(format!("{refused}: refused without a remedy")),
        };
        let told = |what: String| format!("{name}, seed {seed}, change {done}, {edits:?}: {what}");
        let label = "Change".to_owned();
        let edit = Command::Edit {
            edits: edits.clone(),
            label,
        };
        if run(&mut session, edit).is_err() {
            continue;
        }
        let after = State::of(&mut session)?;
        kept(&before.pattern, &after.pattern, &edits).map_err(told)?;
        one_a_cause(&after).map_err(told)?;
        suspended(&session.evaluation(), &after).map_err(told)?;
        // A change that changes nothing is no step.
        if before.pattern != after.pattern {
            run(&mut session, Command::Undo)?;
            State::of(&mut session)?
                .same(&before, "undone")
                .map_err(told)?;
            run(&mut session, Command::Redo)?;
            State::of(&mut session)?
                .same(&after, "done again")
                .map_err(told)?;
        }
        done += 1;
    }
    let last = State::of(&mut session)?;
    let replayed = Session::replay(&session.journal(), folder, &mut Silent);
    let (mut replayed, _) = replayed.map_err(|error| format!("seed {seed}: {error}"))?;
    State::of(&mut replayed)?.same(&last, &format!("{name}, seed {seed}, replayed"))?;
    while session.can_undo().is_some() {
        run(&mut session, Command::Undo)?;
    }
    State::of(&mut session)?.same(&first, &format!("{name}, seed {seed}, all undone"))
}

/// A pattern that ships after random deletions and changes of count, none of which leaves a fault: the garment
/// can be made.
///
/// # Errors
/// A command that is refused.
pub fn sound_after_changes(seed: u64) -> Result<Arc<Pattern>, String> {
    let mut random = Random(seed);
    let (path, _) = SAMPLES[seed as usize % SAMPLES.len()];
    let mut session = Session::new();
    run(&mut session, Command::open(path))?;
    for _ in 0..random.below(CHANGES) {
        let Ok(edits) = changes(&session.evaluation(), &mut random) else {
            continue;
        };
        let label = "Change".to_owned();
        let before = session.revision();
        if run(&mut session, Command::Edit { edits, label }).is_err()
            || session.revision() == before
        {
            continue;
        }
        let found = session.diagnostics();
        if found.iter().any(|one| one.severity == Severity::Error) {
            run(&mut session, Command::Undo)?;
        }
    }
    Ok(session.project().pattern.clone())
}

/// A deletion by a planner or a raw one, or a panel cut another number of times.
fn changes(evaluation: &Evaluation, random: &mut Random) -> Result<Vec<Edit>, EditError> {
    let pattern = evaluation.pattern();
    let parts: Vec<PartId> = pattern.parts().into_iter().map(|(id, _)| id).collect();
    if parts.is_empty() {
        return plan::add_sheet(evaluation, None, [0.0; 2]).map(|done| done.0);
    }
    let part = parts[random.below(parts.len())];
    match random.below(5) {
        0 | 1 => plan::remove_parts(evaluation, &[part]),
        2 => {
            let other = parts[random.below(parts.len())];
            plan::remove_parts(evaluation, &[part, other])
        }
        3 => Ok(vec![Edit::Remove(part)]),
        _ => {
            let panel = pattern.panels.get(random.below(pattern.panels.len()));
            let put = panel.map(|panel| counted(panel, random));
            Ok(put.into_iter().collect())
        }
    }
}

/// The edit after which a panel is cut another number of times.
fn counted(panel: &Panel, random: &mut Random) -> Edit {
    let mut put = panel.clone();
    put.cut.quantity = random.below(MAX_CUT + 1) as u32;
    put.cut.mirrored = random.below(2) == 0;
    Edit::Put(Entity::Panel(Arc::new(put)))
}

/// A raw deletion takes one part with what is inside it, and nothing else.
fn kept(before: &Pattern, after: &Pattern, edits: &[Edit]) -> Result<(), String> {
    let [Edit::Remove(part)] = edits else {
        return Ok(());
    };
    let mut gone: HashSet<PartId> = HashSet::from([*part]);
    match part {
        PartId::Sheet(id) => {
            if let Some(sheet) = before.sheet(*id) {
                gone.extend(sheet.points.iter().map(|point| PartId::from(point.id)));
                gone.extend(sheet.curves.iter().map(|curve| PartId::from(curve.id)));
            }
        }
        PartId::Panel(id) => {
            let panel = before.panel(*id).into_iter();
            gone.extend(panel.flat_map(|p| p.own_parts()).map(|(id, _)| id));
        }
        _ => {}
    }
    let mut left = before.parts();
    left.retain(|(id, _)| !gone.contains(id));
    match left == after.parts() {
        true => Ok(()),
        false => Err("more is gone than was removed".to_owned()),
    }
}

fn known(pattern: &Pattern) -> HashSet<PartId> {
    pattern.parts().into_iter().map(|(id, _)| id).collect()
}

/// No place has two errors of one thing it lacks, and none that lacks nothing itself has any.
fn one_a_cause(state: &State) -> Result<(), String> {
    let lacks = [Code::MissingReference, Code::MissingSpan, Code::Formula];
    let errors = state.found.iter().filter(|one| {
        one.severity == Severity::Error && lacks.contains(&one.code) && one.place != Place::Pattern
    });
    let known = known(&state.pattern);
    let entities = state.pattern.entities();
    let mut told: Vec<&Diagnostic> = Vec::new();
    for error in errors {
        // A seam may lack several things, each of which has words of its own.
        let again = |other: &&&Diagnostic| {
            let is_seam = matches!(error.place, Place::Seam(_));
            other.place == error.place && (!is_seam || other.message == error.message)
        };
        if let Some(other) = told.iter().find(again) {
            return Err(format!("two errors of one cause: {other} and {error}"));
        }
        told.push(error);
        let is_alone = matches!(
            error.place,
            Place::Point(_) | Place::Curve(_) | Place::Variable(_)
        );
        let own = entities.iter().find(|(_, place)| *place == error.place);
        let lost = own.is_some_and(|(entity, _)| {
            let mut references = entity.references().into_iter();
            references.any(|id| !known.contains(&id))
        });
        if is_alone && !lost {
            return Err(format!("told where nothing is missing: {error}"));
        }
    }
    Ok(())
}

/// What refers to something that is gone is not drawn.
fn suspended(evaluation: &Evaluation, state: &State) -> Result<(), String> {
    let known = known(&state.pattern);
    for (entity, place) in state.pattern.entities() {
        let lost = entity
            .references()
            .into_iter()
            .find(|id| !known.contains(id));
        let Some(lost) = lost else { continue };
        let drawn = match &place {
            Place::Point(id) => evaluation.point(*id).is_some(),
            Place::Curve(id) => evaluation.curve(*id).is_some(),
            Place::Variable(id) => evaluation.variable(*id).is_some(),
            Place::Seam(id) => {
                let mut seams = state.draft.seams.iter();
                seams.any(|seam| seam.id == SeamOrigin::Seam(*id))
            }
            _ => false,
        };
        if drawn {
            return Err(format!("{} is drawn without {lost}", entity.name()));
        }
    }
    Ok(())
}
