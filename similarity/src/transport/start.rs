//! The initial tree: cheap arcs first, with as much flow as possible.

use super::candidates::Arc;
use super::spanning_tree::SpanningTree;

/// A feasible tree: masses move along the candidates in order, the rest to the nearest sinks with capacity left.
pub(super) fn greedy(sources: &[i64], sinks: &[i64], costs: &[f64], candidates: &[Arc]) -> SpanningTree {
    let (mut supply, mut demand) = (sources.to_vec(), sinks.to_vec());
    let mut flows: Vec<(usize, usize, i64)> = Vec::with_capacity(sources.len() + sinks.len());
    let mut send = |source: usize, sink: usize, supply: &mut [i64], demand: &mut [i64]| {
        let flow = supply[source].min(demand[sink]);
        if flow > 0 {
            supply[source] -= flow;
            demand[sink] -= flow;
            flows.push((source, sink, flow));
        }
    };
    for arc in candidates {
        send(arc.source as usize, arc.sink as usize, &mut supply, &mut demand);
    }
    for (source, row) in costs.chunks_exact(sinks.len()).enumerate() {
        while supply[source] > 0 {
            let open = (0..sinks.len()).filter(|&sink| demand[sink] > 0);
            let Some(sink) = open.min_by(|&a, &b| row[a].total_cmp(&row[b])) else {
                break;
            };
            send(source, sink, &mut supply, &mut demand);
        }
    }
    join_trees(sources.len(), sinks.len(), costs, &flows)
}

/// Joins the arcs that carry flow, which form trees because each exhausts one of its ends, into one tree. An empty arc leads
/// from the source at the top of a tree to the nearest sink of earlier trees, as strong feasibility requires.
fn join_trees(sources: usize, sinks: usize, costs: &[f64], flows: &[(usize, usize, i64)]) -> SpanningTree {
    let mut neighbours: Vec<Vec<(usize, i64)>> = vec![Vec::new(); sources + sinks];
    for &(source, sink, flow) in flows {
        neighbours[source].push((sources + sink, flow));
        neighbours[sources + sink].push((source, flow));
    }
    let cost = |a: usize, b: usize| costs[a.min(b) * sinks + a.max(b) - sources];
    let mut tree = SpanningTree::unjoined(sources, sinks);
    let mut reached = vec![false; sources + sinks];
    let mut reached_sinks: Vec<usize> = Vec::with_capacity(sinks);
    let mut open = Vec::new();
    for top in 0..sources {
        if reached[top] {
            continue;
        }
        let by_cost = |a: &&usize, b: &&usize| cost(top, **a).total_cmp(&cost(top, **b));
        if let Some(&nearest) = reached_sinks.iter().min_by(by_cost) {
            tree.join(top, nearest, 0, cost(top, nearest));
        }
        reached[top] = true;
        open.push(top);
        while let Some(node) = open.pop() {
            for &(next, flow) in &neighbours[node] {
                if !reached[next] {
                    reached[next] = true;
                    tree.join(next, node, flow, cost(node, next));
                    open.push(next);
                    if next >= sources {
                        reached_sinks.push(next);
                    }
                }
            }
        }
    }
    tree
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::candidates::nearest;

    #[test]
    fn initial_tree_moves_everything_and_spans_all_nodes() {
        let (sources, sinks) = ([3, 3, 1], [1, 2, 3, 1]);
        let costs: Vec<f64> = (0..12).map(|k| f64::from((k * 5) % 7)).collect();
        let tree = greedy(&sources, &sinks, &costs, &nearest(&costs, 4));
        let arcs: Vec<_> = tree.arcs().collect();
        assert_eq!(arcs.len(), 6);
        for (index, &mass) in sources.iter().enumerate() {
            assert_eq!(
                arcs.iter().filter(|arc| arc.0 == index).map(|arc| arc.2).sum::<i64>(),
                mass
            );
        }
        for (index, &mass) in sinks.iter().enumerate() {
            assert_eq!(
                arcs.iter().filter(|arc| arc.1 == index).map(|arc| arc.2).sum::<i64>(),
                mass
            );
        }
    }
}
