//! Takes over the changes of a pattern: definitions of nodes, their dependencies, names.

use super::Evaluation;
use super::needs::Needs;
use super::node::{Definition, Node, NodeState};
use crate::{Panel, PanelId, Pattern, Point, PointRule, Sheet};
use std::collections::HashSet;
use std::sync::Arc;

impl Evaluation {
    /// Sets the definitions that differ from those in the pattern `before`. Returns the numbers of the nodes
    /// that may have other values or dependencies now.
    pub(super) fn take_over(&mut self, before: &Pattern) -> Vec<u32> {
        let pattern = self.pattern.clone();
        let mut changed: Vec<u32> = Vec::new();
        // Sheets that are new, that are removed, or that lie on another panel stage than before.
        let mut laid: Vec<Arc<Sheet>> = Vec::new();
        let same = |a: usize, b: usize, equal: &dyn Fn(usize) -> bool| a == b && (0..a).all(equal);
        if !same(pattern.variables.len(), before.variables.len(), &|k| {
            Arc::ptr_eq(&pattern.variables[k], &before.variables[k])
        }) {
            self.remove_missing(
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
            laid.extend(
                gone.iter()
                    .filter(|s| pattern.sheet(s.id).is_none())
                    .cloned(),
            );
            self.remove_missing(
                nodes(&gone).into_iter(),
                nodes(&come).into_iter(),
                &mut changed,
            );
            for sheet in &come {
                let was_on = before.sheet(sheet.id).map(|sheet| sheet.on);
                if was_on != Some(sheet.on) {
                    laid.push(sheet.clone());
                }
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
        }
        if !same(pattern.seams.len(), before.seams.len(), &|k| {
            Arc::ptr_eq(&pattern.seams[k], &before.seams[k])
        }) {
            self.remove_missing(
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
            // A trued edge keeps its direction at a corner where a seam ends, so stages with trued darts
            // depend on the seams.
            let trued = pattern.panels.iter().flat_map(|panel| {
                let own = panel.operations.iter();
                let own = own.filter(|step| step.kind.may_true());
                own.map(|step| Node::Stage(panel.id, Some(step.id)))
            });
            changed.extend(trued.filter_map(|node| self.index.get(&node)));
        }
        for sheet in laid {
            let marked = |point: &&Arc<Point>| matches!(point.rule, PointRule::Mark { .. });
            let points = sheet.points.iter().filter(marked);
            let inserts = pattern.panels.iter().flat_map(|panel| {
                let own = panel.operations.iter();
                let own = own.filter(|step| step.kind.sheet() == Some(sheet.id));
                own.map(|step| Node::Stage(panel.id, Some(step.id)))
            });
            let nodes = points.map(|point| Node::Point(point.id)).chain(inserts);
            changed.extend(nodes.filter_map(|node| self.index.get(&node)));
        }
        changed
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

    /// The number of a node; a node that does not exist is made.
    pub(super) fn number_of(&mut self, node: Node) -> u32 {
        if let Some(&k) = self.index.get(&node) {
            return k;
        }
        let k = self.nodes.len() as u32;
        Arc::make_mut(&mut self.index).insert(node, k);
        self.nodes.push(Arc::new(NodeState {
            node,
            definition: match node {
                Node::Word(_) => Definition::Word,
                Node::Variable(_)
                | Node::Point(_)
                | Node::Curve(_)
                | Node::Edge(_)
                | Node::Stage(..)
                | Node::Seam(_) => Definition::Missing,
            },
            needs: Vec::new(),
            needed_by: Vec::new(),
            watches: Vec::new(),
            rank: 0,
            cycle: None,
            value: Err(k),
            last_good: None,
            changed: 0,
            missing: false,
            by_name: false,
            diagnostics: Vec::new(),
        }));
        k
    }

    fn define(&mut self, node: Node, definition: Definition, changed: &mut Vec<u32>) {
        let k = self.number_of(node);
        if !self.nodes[k as usize].definition.is(&definition) {
            self.state_mut(k).definition = definition;
            changed.push(k);
        }
    }

    /// Marks the nodes of removed parts as missing.
    fn remove_missing(
        &mut self,
        before: impl Iterator<Item = Node>,
        now: impl Iterator<Item = Node>,
        changed: &mut Vec<u32>,
    ) {
        let now: HashSet<Node> = now.collect();
        for node in before.filter(|node| !now.contains(node)) {
            self.define(node, Definition::Missing, changed);
        }
    }

    /// Registers the panels that decide on which other nodes the node `k` depends: when such a panel changes,
    /// the dependencies of the node are found again. Panels registered for the node before are dropped.
    fn watch(&mut self, k: u32, panels: Vec<PanelId>) {
        if self.nodes[k as usize].watches == panels {
            return;
        }
        let old = std::mem::replace(&mut self.state_mut(k).watches, panels.clone());
        let watchers = Arc::make_mut(&mut self.watchers);
        for panel in old {
            if let Some(nodes) = watchers.get_mut(&panel) {
                nodes.remove(&k);
            }
        }
        for panel in panels {
            watchers.entry(panel).or_default().insert(k);
        }
    }

    /// Finds the nodes that a node depends on; returns whether its dependencies changed.
    pub(super) fn set_needs(&mut self, k: u32) -> bool {
        let definition = self.nodes[k as usize].definition.clone();
        let found = Needs::of(&definition, &self.pattern, &self.names);
        let (nodes, words, panels) = (found.nodes, found.words, found.panels);
        if self.nodes[k as usize].by_name != found.by_name {
            self.state_mut(k).by_name = found.by_name;
        }
        let mut needs: Vec<u32> = nodes.iter().map(|&n| self.number_of(n)).collect();
        if let Node::Word(word) = self.nodes[k as usize].node {
            let variable = self.variable_called(&self.word_texts[word as usize]);
            needs.extend(variable.map(|id| self.number_of(Node::Variable(id))));
        }
        for word in words {
            let next = self.word_texts.len() as u32;
            let number = *self.words.entry(word.clone()).or_insert(next);
            if number == next {
                self.word_texts.push(word);
            }
            needs.push(self.number_of(Node::Word(number)));
        }
        needs.sort_unstable();
        needs.dedup();
        self.watch(k, panels);
        if self.nodes[k as usize].needs == needs {
            return false;
        }
        let old = std::mem::replace(&mut self.state_mut(k).needs, needs.clone());
        for n in old {
            self.state_mut(n).needed_by.retain(|&other| other != k);
        }
        for n in needs {
            self.state_mut(n).needed_by.push(k);
        }
        true
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

/// Whether parts were added, removed, reordered or renamed. Names in formulas may then stand for other parts,
/// and messages may have other words.
pub(super) fn is_renamed(before: &Pattern, now: &Pattern) -> bool {
    !alike(&before.sizes, &now.sizes, |_, _| false)
        || !alike(&before.fabrics, &now.fabrics, |a, b| {
            (a.id, &a.name) == (b.id, &b.name)
        })
        || !alike(&before.variables, &now.variables, |a, b| {
            (a.id, &a.name) == (b.id, &b.name)
        })
        || !alike(&before.sheets, &now.sheets, |a, b| {
            (a.id, &a.name) == (b.id, &b.name)
                && alike(&a.points, &b.points, |a, b| {
                    (a.id, &a.name) == (b.id, &b.name)
                })
                && alike(&a.curves, &b.curves, |a, b| {
                    (a.id, &a.name) == (b.id, &b.name)
                })
        })
        || !alike(&before.panels, &now.panels, is_called_alike)
        || !alike(&before.seams, &now.seams, |a, b| {
            (a.id, &a.name) == (b.id, &b.name)
        })
}

/// Whether two lists have the same number of parts, each equal to its counterpart by `same`.
fn alike<T>(before: &[Arc<T>], now: &[Arc<T>], same: impl Fn(&T, &T) -> bool) -> bool {
    let mut pairs = before.iter().zip(now);
    before.len() == now.len() && pairs.all(|(a, b)| Arc::ptr_eq(a, b) || same(a, b))
}

fn is_called_alike(a: &Panel, b: &Panel) -> bool {
    let lines = |panel: &Panel| -> Vec<_> {
        let lines = panel.lines.iter();
        lines.map(|line| (line.id, line.name.clone())).collect()
    };
    let edges = |panel: &Panel| -> Vec<_> {
        let edges = panel.edges();
        edges.map(|e| (e.id, e.name.clone(), e.ends)).collect()
    };
    let notches = |panel: &Panel| -> Vec<_> {
        let notches = panel.notches.iter();
        notches
            .map(|notch| (notch.id, notch.name.clone()))
            .collect()
    };
    (a.id, &a.name, a.source) == (b.id, &b.name, b.source)
        && lines(a) == lines(b)
        && edges(a) == edges(b)
        && notches(a) == notches(b)
        && alike(&a.operations, &b.operations, |a, b| {
            (a.id, &a.name) == (b.id, &b.name)
        })
}
