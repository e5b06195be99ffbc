//! Candidate arcs that are likely to carry flow: for each source, the arcs to its nearest sinks.

/// An arc between a source and a sink, inside or outside the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    pub(super) cost: f64,
    pub(super) source: u32,
    pub(super) sink: u32,
}

/// Number of sinks per source that are tried first. For grids of 25 × 25 random masses, 16 to 32 took the least time.
const NEAREST: usize = 24;

/// The cheapest arcs of each source, all sorted by cost, ties by source and sink.
pub(super) fn nearest(costs: &[f64], sinks: usize) -> Vec<Arc> {
    let num_kept = NEAREST.min(sinks);
    let mut arcs = Vec::with_capacity(costs.len() / sinks * num_kept);
    let mut order: Vec<u32> = Vec::with_capacity(sinks);
    for (source, row) in costs.chunks_exact(sinks).enumerate() {
        order.clear();
        order.extend(0..sinks as u32);
        let by_cost = |a: &u32, b: &u32| row[*a as usize].total_cmp(&row[*b as usize]).then(a.cmp(b));
        if num_kept < sinks {
            order.select_nth_unstable_by(num_kept - 1, by_cost);
        }
        arcs.extend(order[..num_kept].iter().map(|&sink| Arc {
            cost: row[sink as usize],
            source: source as u32,
            sink,
        }));
    }
    arcs.sort_unstable_by(|a, b| {
        let ends = |arc: &Arc| (arc.source, arc.sink);
        a.cost.total_cmp(&b.cost).then(ends(a).cmp(&ends(b)))
    });
    arcs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cheapest_arcs_of_each_source_are_sorted() {
        let sinks = NEAREST + 10;
        let costs: Vec<f64> = (0..3 * sinks).map(|k| ((k * 37) % 101) as f64).collect();
        let arcs = nearest(&costs, sinks);
        assert_eq!(arcs.len(), 3 * NEAREST);
        assert!(arcs.windows(2).all(|pair| pair[0].cost <= pair[1].cost));
        for (source, row) in costs.chunks(sinks).enumerate() {
            let mut sorted = row.to_vec();
            sorted.sort_by(f64::total_cmp);
            let of_source: Vec<f64> = arcs
                .iter()
                .filter(|arc| arc.source as usize == source)
                .map(|arc| arc.cost)
                .collect();
            assert_eq!(of_source, sorted[..NEAREST]);
        }
    }
}
