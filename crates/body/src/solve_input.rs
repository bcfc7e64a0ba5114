//! The input from which a body is solved.

use crate::request::Request;
use crate::rings::TemplateSkin;
use crate::template::Template;
use crate::template_marks::TemplateMarks;

/// Input of the solution: a template with its skin and marks, and the requested measurements.
pub(crate) struct SolveInput<'a> {
    pub(crate) template: &'a Template,
    pub(crate) skin: &'a TemplateSkin,
    pub(crate) marks: TemplateMarks,
    pub(crate) request: Request,
}

impl SolveInput<'_> {
    /// Ratio of statures, body to template.
    pub(crate) fn stature_ratio(&self) -> f64 {
        self.request.get("height") / self.template.height
    }

    /// Vertices of the median plane among which the crotch may have its lowest point.
    pub(crate) fn crotch_vertices(&self) -> Vec<u32> {
        (0..self.skin.mirror.len() as u32)
            .filter(|&v| {
                let y = self.skin.mesh.positions[v as usize].y;
                self.skin.mirror[v as usize] == v && y < self.marks.crotch.height + 0.05
            })
            .collect()
    }
}
