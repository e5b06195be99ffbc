//! [`SpanningTree`]: a basis of a transport problem, with pivots.

/// The parent of the root, and the end of every list of siblings.
const NONE: u32 = u32::MAX;

/// A source or sink, with the arc to its parent in the tree.
#[derive(Clone, Copy, Debug)]
struct Node {
    parent: u32,
    first_child: u32,
    next: u32,
    previous: u32,
    depth: u32,
    /// Units on the arc between this node and its parent.
    flow: i64,
    price: f64,
}

/// Sources and sinks joined by `sources + sinks − 1` arcs, each between a source and a sink.
///
/// The prices of an arc's ends add up to its cost, so an arc outside the tree costs its reduced cost more than the path through
/// the tree. Always strongly feasible: an arc without flow leads from a source up to its parent. Then pivots cannot cycle
/// (Cunningham 1976).
#[derive(Clone, Debug)]
pub(crate) struct SpanningTree {
    nodes: Vec<Node>,
    sources: usize,
}

impl SpanningTree {
    /// Nodes without arcs: sources first, then sinks.
    pub(super) fn unjoined(sources: usize, sinks: usize) -> Self {
        let blank = Node {
            parent: NONE,
            first_child: NONE,
            next: NONE,
            previous: NONE,
            depth: 0,
            flow: 0,
            price: 0.0,
        };
        Self {
            nodes: vec![blank; sources + sinks],
            sources,
        }
    }

    /// Attaches `node`, which has no parent yet, to `parent` by an arc of this cost that carries `flow` units.
    pub(super) fn join(&mut self, node: usize, parent: usize, flow: i64, cost: f64) {
        self.attach(node, parent);
        let above = self.nodes[parent];
        let node = &mut self.nodes[node];
        (node.flow, node.depth, node.price) = (flow, above.depth + 1, cost - above.price);
    }

    /// The price of a source, or of sink `k` as node `sources + k`.
    pub(super) fn price(&self, node: usize) -> f64 {
        self.nodes[node].price
    }

    /// Every arc of the tree: source, sink, units.
    pub(super) fn arcs(&self) -> impl Iterator<Item = (usize, usize, i64)> {
        let sources = self.sources;
        self.nodes.iter().enumerate().filter_map(move |(index, node)| {
            let parent = node.parent as usize;
            let joined = node.parent != NONE;
            joined.then(|| {
                let (source, sink) = if index < sources {
                    (index, parent)
                } else {
                    (parent, index)
                };
                (source, sink - sources, node.flow)
            })
        })
    }

    /// Recomputes all prices to clear accumulated rounding errors. `cost` takes a source and a sink.
    pub(super) fn reprice(&mut self, cost: impl Fn(usize, usize) -> f64) {
        let Some(root) = self.nodes.iter().position(|node| node.parent == NONE) else {
            return;
        };
        let sources = self.sources;
        self.nodes[root].price = 0.0;
        self.walk(root, |node, index, above| {
            if index != root {
                let (source, sink) = if index < sources {
                    (index, node.parent as usize)
                } else {
                    (node.parent as usize, index)
                };
                node.price = cost(source, sink - sources) - above.price;
            }
        });
    }

    /// Lets the arc from `source` to `sink` enter with as much flow as possible; the arc that this empties leaves.
    pub(super) fn pivot(&mut self, source: usize, sink: usize, reduced_cost: f64) {
        let sink = self.sources + sink;
        let (apex, blocking) = self.blocking(source, sink);
        if blocking.flow > 0 {
            self.push(source, apex, blocking.flow);
            self.push(sink, apex, blocking.flow);
        }
        let (inner, outer) = if blocking.below_sink {
            (sink, source)
        } else {
            (source, sink)
        };
        self.rehang(inner, outer, blocking);
        // The price at `inner` takes up the reduced cost; below, signs alternate with the kind of node.
        let sources = self.sources;
        let kind = inner < sources;
        self.walk(inner, |node, index, above| {
            node.depth = above.depth + 1;
            node.price += if (index < sources) == kind {
                reduced_cost
            } else {
                -reduced_cost
            };
        });
    }

    /// The node where the paths up from both ends meet, and the arc on them that is emptied first; ties go to the last on the
    /// cycle from the apex through the entering arc, which keeps the tree strongly feasible.
    fn blocking(&self, source: usize, sink: usize) -> (usize, Blocking) {
        let (mut a, mut b) = (source, sink);
        let (mut least_a, mut node_a, mut least_b, mut node_b) = (i64::MAX, source, i64::MAX, sink);
        while a != b {
            let (above_a, above_b) = (&self.nodes[a], &self.nodes[b]);
            if above_a.depth > above_b.depth {
                if a < self.sources && above_a.flow < least_a {
                    (least_a, node_a) = (above_a.flow, a);
                }
                a = above_a.parent as usize;
            } else {
                if b >= self.sources && above_b.flow <= least_b {
                    (least_b, node_b) = (above_b.flow, b);
                }
                b = above_b.parent as usize;
            }
        }
        let below_sink = least_b <= least_a;
        let (node, flow) = if below_sink {
            (node_b, least_b)
        } else {
            (node_a, least_a)
        };
        (a, Blocking { node, flow, below_sink })
    }

    /// Pushes flow along the half of the cycle from `end` up to the apex: arcs above nodes of its kind lose flow, the others gain it.
    fn push(&mut self, end: usize, apex: usize, flow: i64) {
        let kind = end < self.sources;
        let mut index = end;
        while index != apex {
            let same = (index < self.sources) == kind;
            let node = &mut self.nodes[index];
            node.flow += if same { -flow } else { flow };
            index = node.parent as usize;
        }
    }

    /// Reverses the path from `inner` up to the leaving arc, and attaches `inner` to `outer`.
    fn rehang(&mut self, inner: usize, outer: usize, leaving: Blocking) {
        let (mut index, mut parent, mut flow) = (inner, outer, leaving.flow);
        loop {
            let before = self.nodes[index];
            self.detach(index);
            self.attach(index, parent);
            self.nodes[index].flow = flow;
            if index == leaving.node {
                return;
            }
            (flow, parent, index) = (before.flow, index, before.parent as usize);
        }
    }

    /// Visits a subtree from the top, passing each node its parent's data (the top gets its own).
    fn walk(&mut self, top: usize, mut visit: impl FnMut(&mut Node, usize, Above)) {
        let mut index = top;
        loop {
            let parent = self.nodes[index].parent;
            let above = &self.nodes[if parent == NONE { index } else { parent as usize }];
            let above = Above {
                depth: above.depth,
                price: above.price,
            };
            let node = &mut self.nodes[index];
            visit(node, index, above);
            if node.first_child != NONE {
                index = node.first_child as usize;
                continue;
            }
            loop {
                if index == top {
                    return;
                }
                let node = &self.nodes[index];
                if node.next != NONE {
                    index = node.next as usize;
                    break;
                }
                index = node.parent as usize;
            }
        }
    }

    fn attach(&mut self, index: usize, parent: usize) {
        let sibling = std::mem::replace(&mut self.nodes[parent].first_child, index as u32);
        if sibling != NONE {
            self.nodes[sibling as usize].previous = index as u32;
        }
        let node = &mut self.nodes[index];
        (node.parent, node.next, node.previous) = (parent as u32, sibling, NONE);
    }

    fn detach(&mut self, index: usize) {
        let Node {
            parent, next, previous, ..
        } = self.nodes[index];
        if previous == NONE {
            self.nodes[parent as usize].first_child = next;
        } else {
            self.nodes[previous as usize].next = next;
        }
        if next != NONE {
            self.nodes[next as usize].previous = previous;
        }
    }
}

/// Data that a node gets from its parent.
#[derive(Clone, Copy, Debug)]
struct Above {
    depth: u32,
    price: f64,
}

/// The leaving arc: the one above `node`.
#[derive(Clone, Copy, Debug)]
struct Blocking {
    node: usize,
    /// The flow that it carries.
    flow: i64,
    /// Whether it is on the sink's side of the cycle.
    below_sink: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two sources of 1 and two sinks of 1, matched crosswise and joined by an empty arc.
    fn crossed() -> SpanningTree {
        let costs = [[0.0, 5.0], [5.0, 0.0]];
        let mut tree = SpanningTree::unjoined(2, 2);
        tree.join(3, 0, 1, costs[0][1]);
        tree.join(1, 3, 0, costs[1][1]);
        tree.join(2, 1, 1, costs[1][0]);
        tree
    }

    #[test]
    fn entering_arc_takes_the_flow_of_a_costlier_path() {
        let mut tree = crossed();
        let reduced_cost = 0.0 - tree.price(0) - tree.price(2);
        assert_eq!(reduced_cost, -10.0);
        tree.pivot(0, 0, reduced_cost);
        let mut arcs: Vec<_> = tree.arcs().collect();
        arcs.sort_unstable();
        assert_eq!(arcs.iter().filter(|arc| arc.2 == 1).count(), 2);
        assert!(arcs.contains(&(0, 0, 1)) && arcs.contains(&(1, 1, 1)), "{arcs:?}");
    }

    #[test]
    fn recomputed_prices_are_the_same() {
        let mut tree = crossed();
        tree.pivot(0, 0, -10.0);
        let before: Vec<f64> = (0..4).map(|node| tree.price(node)).collect();
        tree.reprice(|source, sink| [[0.0, 5.0], [5.0, 0.0]][source][sink]);
        let after: Vec<f64> = (0..4).map(|node| tree.price(node)).collect();
        assert_eq!(before, after);
    }
}
