//! Brings an evaluation up to date: sorts the graph of dependencies and recomputes changed values.

use super::changes::is_renamed;
use super::duplicates::duplicates;
use super::node::{Definition, Node};
use super::{Evaluation, Update, Wearer};
use crate::formula::Names;
use crate::{Pattern, PointId};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};
use std::sync::Arc;

impl Evaluation {
    /// Brings all values up to date with a pattern and a wearer.
    pub fn update(&mut self, pattern: &Pattern, wearer: impl Into<Wearer>) -> Update {
        let known = self.nodes.len();
        let dirty = self.take_changes(pattern, Some(wearer.into()));
        let update = Update {
            met: self.nodes.len() - known,
            ..self.recompute(dirty)
        };
        tracing::debug!(
            values = self.nodes.len(),
            recomputed = update.computed,
            changed = update.changed,
            "pattern evaluated"
        );
        update
    }

    /// Brings these points and all values that they depend on up to date with a pattern; other values stay
    /// outdated. For planners, which read the positions of the points and then discard the evaluation.
    pub(crate) fn update_points(&mut self, pattern: &Pattern, points: &[PointId]) {
        let dirty = self.take_changes(pattern, None);
        let nodes = points.iter().map(|&id| Node::Point(id));
        let mut open: Vec<u32> = nodes.filter_map(|n| self.index.get(&n).copied()).collect();
        let mut wanted = HashSet::new();
        while let Some(k) = open.pop() {
            if wanted.insert(k) {
                open.extend(&self.nodes[k as usize].needs);
            }
        }
        self.recompute_among(dirty, |k| wanted.contains(&k));
    }

    /// Takes over the changes of the pattern, and the wearer if it is not `None`; returns the nodes that must
    /// be recomputed.
    fn take_changes(&mut self, pattern: &Pattern, wearer: Option<Wearer>) -> HashSet<u32> {
        self.revision += 1;
        let before = std::mem::replace(&mut self.pattern, pattern.clone());
        let mut remeasured = before.base_measurements() != pattern.base_measurements();
        let mut resized = false;
        if let Some(wearer) = wearer.filter(|wearer| *wearer != *self.wearer) {
            remeasured |= self.wearer.measurements != wearer.measurements;
            resized = self.wearer.size != wearer.size;
            self.wearer = Arc::new(wearer);
        }
        let mut dirty: HashSet<u32> = self.take_over(&before).into_iter().collect();
        let renamed = self.revision == 1 || is_renamed(&before, pattern);
        if renamed {
            self.names = Arc::new(Names::new(pattern));
            self.duplicates = duplicates(pattern);
        }
        if renamed || remeasured {
            // A part that a formula did not find may exist now, and messages may have other words.
            dirty.extend((0..self.nodes.len() as u32).filter(|&k| {
                let state = &self.nodes[k as usize];
                let is_word = matches!(state.node, Node::Word(_));
                is_word || state.by_name || !state.diagnostics.is_empty()
            }));
        }
        self.follow_needs(&mut dirty);
        if resized {
            dirty.extend(0..self.nodes.len() as u32);
        }
        dirty
    }

    /// Finds the dependencies of these nodes again, and sorts the graph anew if they changed.
    fn follow_needs(&mut self, dirty: &mut HashSet<u32>) {
        let mut waiting: Vec<u32> = dirty.iter().copied().collect();
        waiting.sort_unstable();
        let mut reordered = false;
        while !waiting.is_empty() {
            let known = self.nodes.len() as u32;
            for k in waiting.drain(..) {
                reordered |= self.set_needs(k);
            }
            // Words that formulas use for the first time depend on the variables with their names.
            waiting.extend(known..self.nodes.len() as u32);
            dirty.extend(&waiting);
        }
        if reordered {
            self.order();
            dirty.extend((0..self.nodes.len() as u32).filter(|&k| {
                let state = &self.nodes[k as usize];
                state.cycle.is_some() || state.changed == 0
            }));
        }
    }

    /// Sorts all nodes so that each follows those that it depends on, and finds cycles. Tarjan's algorithm
    /// (1972) gives the strongly connected components in that order.
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
            // Each call of the recursive form is an entry: the node, and the number of its dependencies
            // visited so far.
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
                let named =
                    component
                        .iter()
                        .copied()
                        .min_by_key(|&w| match self.nodes[w as usize].node {
                            // A word is in a cycle only because of the variable with its name: the diagnostic
                            // is about that variable instead.
                            Node::Word(_) => (true, Node::Word(0)),
                            node @ (Node::Variable(_)
                            | Node::Point(_)
                            | Node::Curve(_)
                            | Node::Edge(_)
                            | Node::Stage(..)
                            | Node::Seam(_)) => (false, node),
                        });
                for w in component {
                    on_stack[w as usize] = false;
                    let cycle = if is_cycle { named } else { None };
                    let known = &self.nodes[w as usize];
                    if known.rank == rank && known.cycle == cycle {
                        continue;
                    }
                    let state = self.state_mut(w);
                    state.rank = rank;
                    let was = std::mem::replace(&mut state.cycle, cycle);
                    if was.is_some() && !is_cycle {
                        // The node is no longer in a cycle: it is computed like a new one.
                        state.changed = 0;
                    }
                }
                rank += 1;
            }
        }
    }

    /// Recomputes these nodes and all nodes that depend on them, in the order of their ranks.
    fn recompute(&mut self, dirty: HashSet<u32>) -> Update {
        self.recompute_among(dirty, |_| true)
    }

    /// Recomputes these nodes and all nodes that depend on them, in the order of their ranks, except nodes
    /// for which `wanted` is false.
    fn recompute_among(&mut self, dirty: HashSet<u32>, wanted: impl Fn(u32) -> bool) -> Update {
        let mut update = Update::default();
        let mut waiting: HashSet<u32> = dirty.into_iter().filter(|&k| wanted(k)).collect();
        let mut queue: BinaryHeap<Reverse<(u32, u32)>> = waiting
            .iter()
            .map(|&k| Reverse((self.nodes[k as usize].rank, k)))
            .collect();
        while let Some(Reverse((_, k))) = queue.pop() {
            waiting.remove(&k);
            update.computed += 1;
            let (value, diagnostics) = self.compute(k);
            let revision = self.revision;
            let state = self.state_mut(k);
            state.diagnostics = diagnostics;
            // Nodes that depend on this one must also be recomputed if its part appears or disappears: they
            // report a missing part themselves, but not a part with a fault.
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
                if !cyclic && wanted(n) && waiting.insert(n) {
                    queue.push(Reverse((self.nodes[n as usize].rank, n)));
                }
            }
        }
        update
    }
}
