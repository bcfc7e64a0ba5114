//! Union-find data structures, plain and with an orientation between members.

/// Disjoint sets that can be joined.
pub(crate) struct Links {
    parent: Vec<usize>,
}

impl Links {
    pub fn new(count: usize) -> Self {
        Self {
            parent: (0..count).collect(),
        }
    }

    /// Representative of a member's set: the smallest member.
    pub fn root(&mut self, member: usize) -> usize {
        let mut member = member;
        while self.parent[member] != member {
            self.parent[member] = self.parent[self.parent[member]];
            member = self.parent[member];
        }
        member
    }

    /// Joins the sets of two members.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b);
    }
}

/// Disjoint sets of members, each with the same or the opposite direction as its root.
pub(crate) struct OrientedLinks {
    parent: Vec<(usize, bool)>,
    symmetric: Vec<bool>,
}

impl OrientedLinks {
    pub fn new(count: usize) -> Self {
        Self {
            parent: (0..count).map(|k| (k, false)).collect(),
            symmetric: vec![false; count],
        }
    }

    /// The root of a member's set, and whether the member has the opposite direction.
    pub fn root(&self, member: usize) -> (usize, bool) {
        let (mut member, mut reversed) = (member, false);
        while self.parent[member].0 != member {
            reversed ^= self.parent[member].1;
            member = self.parent[member].0;
        }
        (member, reversed)
    }

    /// Joins two members with the same direction, or with opposite directions if `opposed`.
    pub fn join(&mut self, a: usize, b: usize, opposed: bool) {
        let ((a, a_back), (b, b_back)) = (self.root(a), self.root(b));
        let flip = a_back ^ b_back ^ opposed;
        if a == b {
            self.symmetric[a] |= flip;
            return;
        }
        let (low, high) = (a.min(b), a.max(b));
        self.parent[high] = (low, flip);
        self.symmetric[low] |= self.symmetric[high];
    }

    /// Whether the members of a set are also joined to themselves with reversed direction.
    pub fn is_symmetric(&self, root: usize) -> bool {
        self.symmetric[root]
    }
}
