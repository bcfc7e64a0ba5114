//! Takes over what changed in a pattern, orders the graph, recomputes.

use super::node::{Definition, Needs, Node, NodeState};
use super::{Evaluation, Update};
use crate::formula::Names;
use crate::{Code, Diagnostic, Panel, Pattern, Place, Sheet};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};
use std::sync::Arc;
use toile_measure::Measurements;

impl Evaluation {
    /// Brings all values up to date with a pattern and measurements.
    pub fn update(&mut self, pattern: &Pattern, measurements: &Measurements) -> Update {
        self.revision += 1;
        let before = std::mem::replace(&mut self.pattern, pattern.clone());
        let size = pattern
            .sizes
            .iter()
            .find(|size| size.measurements == *measurements);
        let size = size.map(|size| size.id);
        let remeasured = self.given != *measurements
            || before.base_measurements() != pattern.base_measurements();
        let resized = self.size != size;
        self.given = measurements.clone();
        self.size = size;
        let mut dirty: HashSet<u32> = HashSet::new();
        let structural = self.take_over(&before, &mut dirty);
        if structural {
            self.names = Arc::new(Names::new(pattern));
            self.find_duplicates();
            self.order();
            dirty.extend((0..self.nodes.len() as u32).filter(|&k| {
                let state = &self.nodes[k as usize];
                state.cycle.is_some() || state.changed == 0
            }));
        }
        if remeasured {
            dirty.extend(
                self.words
                    .values()
                    .filter_map(|&w| self.index.get(&Node::Word(w))),
            );
        }
        if resized {
            dirty.extend(0..self.nodes.len() as u32);
        }
        self.recompute(dirty)
    }

    /// Sets the definitions that changed. Whether needs or names did.
    fn take_over(&mut self, before: &Pattern, dirty: &mut HashSet<u32>) -> bool {
        let pattern = self.pattern.clone();
        let mut changed: Vec<u32> = Vec::new();
        let mut renamed = false;
        let same = |a: usize, b: usize, equal: &dyn Fn(usize) -> bool| a == b && (0..a).all(equal);
        if !same(pattern.variables.len(), before.variables.len(), &|k| {
            Arc::ptr_eq(&pattern.variables[k], &before.variables[k])
        }) {
            renamed |= self.remove_missing(
                before.variables.iter().map(|v| Node::Variable(v.id)),
                pattern.variables.iter().map(|v| Node::Variable(v.id)),
                &mut changed,
            );
            for variable in &pattern.variables {
                self.define(
                    Node::Variable(variable.id),
                    Definition::Variable(variable.clone()),
                    &mut changed,
                );
            }
        }
        if !same(pattern.sheets.len(), before.sheets.len(), &|k| {
            Arc::ptr_eq(&pattern.sheets[k], &before.sheets[k])
        }) {
            let nodes = |sheets: &[Arc<Sheet>]| -> Vec<Node> {
                let points = sheets
                    .iter()
                    .flat_map(|s| s.points.iter().map(|p| Node::Point(p.id)));
                let curves = sheets
                    .iter()
                    .flat_map(|s| s.curves.iter().map(|c| Node::Curve(c.id)));
                points.chain(curves).collect()
            };
            let old: HashSet<*const Sheet> = before.sheets.iter().map(Arc::as_ptr).collect();
            let new: HashSet<*const Sheet> = pattern.sheets.iter().map(Arc::as_ptr).collect();
            let gone: Vec<Arc<Sheet>> = before
                .sheets
                .iter()
                .filter(|s| !new.contains(&Arc::as_ptr(s)))
                .cloned()
                .collect();
            let come: Vec<Arc<Sheet>> = pattern
                .sheets
                .iter()
                .filter(|s| !old.contains(&Arc::as_ptr(s)))
                .cloned()
                .collect();
            renamed |= self.remove_missing(
                nodes(&gone).into_iter(),
                nodes(&come).into_iter(),
                &mut changed,
            );
            for sheet in &come {
                for point in &sheet.points {
                    self.define(
                        Node::Point(point.id),
                        Definition::Point(point.clone()),
                        &mut changed,
                    );
                }
                for curve in &sheet.curves {
                    self.define(
                        Node::Curve(curve.id),
                        Definition::Curve(curve.clone()),
                        &mut changed,
                    );
                }
            }
        }
        if !same(pattern.panels.len(), before.panels.len(), &|k| {
            Arc::ptr_eq(&pattern.panels[k], &before.panels[k])
        }) {
            let old: HashSet<*const Panel> = before.panels.iter().map(Arc::as_ptr).collect();
            let new: HashSet<*const Panel> = pattern.panels.iter().map(Arc::as_ptr).collect();
            let gone = before
                .panels
                .iter()
                .filter(|p| !new.contains(&Arc::as_ptr(p)));
            let come: Vec<_> = pattern
                .panels
                .iter()
                .filter(|p| !old.contains(&Arc::as_ptr(p)))
                .cloned()
                .collect();
            let gone: Vec<_> = gone.cloned().collect();
            self.remove_missing(
                gone.iter().flat_map(|panel| panel_nodes(panel)),
                come.iter().flat_map(|panel| panel_nodes(panel)),
                &mut changed,
            );
            for panel in &come {
                self.define_panel(panel, &mut changed);
            }
            for panel in gone.iter().chain(&come) {
                changed.extend(self.watchers.get(&panel.id).into_iter().flatten());
            }
            renamed = true;
        }
        if !same(pattern.seams.len(), before.seams.len(), &|k| {
            Arc::ptr_eq(&pattern.seams[k], &before.seams[k])
        }) {
            renamed |= self.remove_missing(
                before.seams.iter().map(|s| Node::Seam(s.id)),
                pattern.seams.iter().map(|s| Node::Seam(s.id)),
                &mut changed,
            );
            for seam in &pattern.seams {
                self.define(
                    Node::Seam(seam.id),
                    Definition::Seam(seam.clone()),
                    &mut changed,
                );
            }
        }
        let mut structural = renamed || self.revision == 1;
        changed.sort_unstable();
        changed.dedup();
        for k in changed {
            dirty.insert(k);
            structural |= self.set_needs(k);
        }
        structural
    }

    fn define_panel(&mut self, panel: &Arc<Panel>, changed: &mut Vec<u32>) {
        for (j, line) in panel.lines.iter().enumerate() {
            for (k, edge) in line.edges.iter().enumerate() {
                let definition = Definition::Edge(panel.clone(), j, k);
                self.define(Node::Edge(edge.id), definition, changed);
            }
        }
        for step in 0..=panel.operations.len() {
            let after = step.checked_sub(1).map(|k| panel.operations[k].id);
            let definition = Definition::Stage(panel.clone(), step);
            self.define(Node::Stage(panel.id, after), definition, changed);
        }
    }

    /// The number of a node, which is made if it is not there.
    pub(super) fn number_of(&mut self, node: Node) -> u32 {
        if let Some(&k) = self.index.get(&node) {
            return k;
        }
        let k = self.nodes.len() as u32;
        self.index.insert(node, k);
        self.nodes.push(NodeState {
            node,
            definition: match node {
                Node::Word(_) => Definition::Word,
                _ => Definition::Missing,
            },
            needs: Vec::new(),
            needed_by: Vec::new(),
            rank: 0,
            cycle: None,
            value: Err(k),
            last_good: None,
            changed: 0,
            missing: false,
            diagnostics: Vec::new(),
        });
        k
    }

    fn define(&mut self, node: Node, definition: Definition, changed: &mut Vec<u32>) {
        let k = self.number_of(node);
        let state = &mut self.nodes[k as usize];
        if !state.definition.is(&definition) {
            state.definition = definition;
            changed.push(k);
        }
    }

    /// Marks parts that are gone. Whether there are any, or new ones.
    fn remove_missing(
        &mut self,
        before: impl Iterator<Item = Node>,
        now: impl Iterator<Item = Node>,
        changed: &mut Vec<u32>,
    ) -> bool {
        let now: HashSet<Node> = now.collect();
        let before: HashSet<Node> = before.collect();
        for node in before.difference(&now) {
            self.define(*node, Definition::Missing, changed);
        }
        before != now
    }

    /// Finds what a node needs. Whether that changed.
    fn set_needs(&mut self, k: u32) -> bool {
        let definition = self.nodes[k as usize].definition.clone();
        let found = Needs::of(&definition, &self.pattern);
        let mut needs: Vec<u32> = found.nodes.iter().map(|&n| self.number_of(n)).collect();
        for word in found.words {
            let next = self.word_texts.len() as u32;
            let number = *self.words.entry(word.clone()).or_insert(next);
            if number == next {
                self.word_texts.push(word);
            }
            needs.push(self.number_of(Node::Word(number)));
        }
        needs.sort_unstable();
        needs.dedup();
        for panel in found.panels {
            let watching = self.watchers.entry(panel).or_default();
            if !watching.contains(&k) {
                watching.push(k);
            }
        }
        if self.nodes[k as usize].needs == needs {
            return false;
        }
        let old = std::mem::replace(&mut self.nodes[k as usize].needs, needs.clone());
        for n in old {
            self.nodes[n as usize].needed_by.retain(|&other| other != k);
        }
        for n in needs {
            self.nodes[n as usize].needed_by.push(k);
        }
        true
    }

    /// Orders all nodes so that what is needed comes first, and finds cycles: strongly connected
    /// components by Tarjan (1972), which come out in that order.
    fn order(&mut self) {
        const UNSEEN: u32 = u32::MAX;
        let count = self.nodes.len();
        let mut index = vec![UNSEEN; count];
        let mut low = vec![0_u32; count];
        let mut on_stack = vec![false; count];
        let mut stack: Vec<u32> = Vec::new();
        let (mut next, mut rank) = (0_u32, 0_u32);
        for root in 0..count as u32 {
            if index[root as usize] != UNSEEN {
                continue;
            }
            // Each call of the recursive form is a node and how many of its needs were followed.
            let mut calls: Vec<(u32, usize)> = vec![(root, 0)];
            while let Some((v, followed)) = calls.pop() {
                let at = v as usize;
                if followed == 0 {
                    index[at] = next;
                    low[at] = next;
                    next += 1;
                    stack.push(v);
                    on_stack[at] = true;
                } else {
                    let w = self.nodes[at].needs[followed - 1] as usize;
                    low[at] = low[at].min(low[w]);
                }
                let mut k = followed;
                let mut descended = false;
                while let Some(&w) = self.nodes[at].needs.get(k) {
                    k += 1;
                    if index[w as usize] == UNSEEN {
                        calls.push((v, k));
                        calls.push((w, 0));
                        descended = true;
                        break;
                    }
                    if on_stack[w as usize] {
                        low[at] = low[at].min(index[w as usize]);
                    }
                }
                if descended || low[at] != index[at] {
                    continue;
                }
                let start = stack.iter().rposition(|&w| w == v).unwrap_or(0);
                let component: Vec<u32> = stack.drain(start..).collect();
                let is_cycle = component.len() > 1 || self.nodes[at].needs.contains(&v);
                let named = component
                    .iter()
                    .copied()
                    .min_by_key(|&w| self.nodes[w as usize].node);
                for w in component {
                    on_stack[w as usize] = false;
                    let state = &mut self.nodes[w as usize];
                    state.rank = rank;
                    let was = state.cycle;
                    state.cycle = if is_cycle { named } else { None };
                    if was.is_some() && !is_cycle {
                        // Out of a cycle: to be computed like what is new.
                        state.changed = 0;
                    }
                }
                rank += 1;
            }
        }
    }

    /// Recomputes nodes and what needs them, in order.
    fn recompute(&mut self, dirty: HashSet<u32>) -> Update {
        let mut update = Update::default();
        let mut waiting: HashSet<u32> = dirty.clone();
        let mut queue: BinaryHeap<Reverse<(u32, u32)>> = dirty
            .iter()
            .map(|&k| Reverse((self.nodes[k as usize].rank, k)))
            .collect();
        while let Some(Reverse((_, k))) = queue.pop() {
            waiting.remove(&k);
            update.computed += 1;
            let (value, diagnostics) = self.compute(k);
            let revision = self.revision;
            let state = &mut self.nodes[k as usize];
            state.diagnostics = diagnostics;
            // What needs a part tells its absence itself, but not its fault.
            let is_missing = matches!(state.definition, Definition::Missing);
            let was_missing = std::mem::replace(&mut state.missing, is_missing);
            let same = state.changed > 0
                && was_missing == is_missing
                && match (&state.value, &value) {
                    (Ok(a), Ok(b)) => a.is_same(b),
                    (Err(a), Err(b)) => a == b,
                    _ => false,
                };
            if same {
                continue;
            }
            if let Ok(value) = &value {
                state.last_good = Some(value.clone());
            }
            state.value = value;
            state.changed = revision;
            update.changed += 1;
            for n in self.nodes[k as usize].needed_by.clone() {
                let cyclic = self.nodes[n as usize].cycle.is_some();
                if !cyclic && waiting.insert(n) {
                    queue.push(Reverse((self.nodes[n as usize].rank, n)));
                }
            }
        }
        update
    }

    /// Ids must be unique, or seams would mean two things; names, or formulas would.
    fn find_duplicates(&mut self) {
        let mut found = Vec::new();
        let mut report = |place: Place, message: String| {
            found.push(Diagnostic::error(
                Code::Duplicate,
                place,
                message,
                "rename or renumber one of them",
            ));
        };
        let pattern = &self.pattern;
        let mut seen = HashSet::new();
        for variable in &pattern.variables {
            if !seen.insert(variable.name.as_str()) {
                let words = format!("two variables are called {:?}", variable.name);
                report(Place::Variable(variable.id), words);
            }
        }
        let mut seen = HashSet::new();
        for panel in &pattern.panels {
            if !seen.insert(panel.name.as_str()) {
                let words = format!("two panels are called {:?}", panel.name);
                report(Place::Panel(panel.id), words);
            }
            let mut edges = HashSet::new();
            for edge in panel.edges() {
                if !edges.insert(edge.name.as_str()) {
                    let words = format!("panel {:?}: two edges {:?}", panel.name, edge.name);
                    report(Place::Edge(panel.id, edge.id), words);
                }
            }
        }
        for sheet in &pattern.sheets {
            let mut points = HashSet::new();
            for point in &sheet.points {
                if !points.insert(point.name.as_str()) {
                    let words = format!("sheet {:?}: two points {:?}", sheet.name, point.name);
                    report(Place::Point(point.id), words);
                }
            }
        }
        let mut ids = HashSet::new();
        for (id, place) in pattern.parts() {
            if !ids.insert(id.number()) {
                report(place, format!("two parts have the id {id}"));
            }
        }
        self.duplicates = found;
    }
}

fn panel_nodes(panel: &Panel) -> Vec<Node> {
    let edges = panel.edges().map(|edge| Node::Edge(edge.id));
    let after = panel.operations.iter().map(|o| Some(o.id));
    let stages = std::iter::once(None).chain(after);
    edges
        .chain(stages.map(|after| Node::Stage(panel.id, after)))
        .collect()
}
