//! Triangles between rows and rings of vertices.

use crate::Part;
use crate::rings::{Half, OPEN};
use std::cmp::Ordering;

impl Half<'_> {
    /// Adds the triangles between two half rows, of which one may have twice as many columns. Triangles with
    /// an open vertex are left out.
    pub(crate) fn strip(&mut self, part: Part, [lower, upper]: [&[u32]; 2]) {
        let open = |corners: &[u32]| corners.contains(&OPEN);
        match lower.len().cmp(&upper.len()) {
            Ordering::Equal => {
                for (below, above) in lower.windows(2).zip(upper.windows(2)) {
                    if !open(below) && !open(above) {
                        self.quad(part, [below[0], below[1], above[1], above[0]]);
                    }
                }
            }
            Ordering::Less => {
                for (i, below) in lower.windows(2).enumerate() {
                    let above = &upper[2 * i..2 * i + 3];
                    self.face(part, [below[0], above[1], above[0]]);
                    self.face(part, [below[0], below[1], above[1]]);
                    self.face(part, [below[1], above[2], above[1]]);
                }
            }
            Ordering::Greater => {
                for (i, above) in upper.windows(2).enumerate() {
                    let below = &lower[2 * i..2 * i + 3];
                    self.face(part, [below[0], below[1], above[0]]);
                    self.face(part, [below[1], above[1], above[0]]);
                    self.face(part, [below[1], below[2], above[1]]);
                }
            }
        }
    }

    /// Adds a quadrilateral as two triangles, split along the shorter diagonal.
    fn quad(&mut self, part: Part, [a, b, c, d]: [u32; 4]) {
        let at = |v: u32| self.positions[v as usize];
        if (at(a) - at(c)).norm() <= (at(b) - at(d)).norm() {
            self.face(part, [a, b, c]);
            self.face(part, [a, c, d]);
        } else {
            self.face(part, [a, b, d]);
            self.face(part, [b, c, d]);
        }
    }

    /// Adds a band between two rings of the same length, the second one farther out on the limb. Triangles
    /// with an open vertex are left out.
    pub(crate) fn band(&mut self, part: Part, from: &[u32], to: &[u32]) {
        let n = from.len();
        for k in 0..n {
            let next = (k + 1) % n;
            let corners = [from[k], from[next], to[next], to[k]];
            if !corners.contains(&OPEN) {
                self.quad(part, corners);
            }
        }
    }
}
