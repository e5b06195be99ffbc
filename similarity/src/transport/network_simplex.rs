//! Network simplex: the exact optimum of a transport problem by pivots of a spanning tree.

use super::candidates::{Arc, nearest};
use super::spanning_tree::SpanningTree;
use super::start::greedy;

/// Pivots per node after which prices are recomputed and the tolerance is doubled, so that rounding cannot make the search run
/// for ever. Problems of random masses need 2 to 4.
const ROUND: usize = 64;

/// Moves units from sources to sinks at minimum cost: source, sink and units of every move, sorted.
///
/// All units are above 0 and both sides have the same number; `costs`: `(sources, sinks)`, finite, row after row.
///
/// Network simplex over a short list of arcs: block search (as in LEMON, Király and Kovács 2012) chooses the entering
/// arc. If the list has none, all arcs are priced, and those that would lower the cost join the list. Once no arc
/// would, the prices prove that the plan is optimal.
pub(super) fn solve(sources: &[i64], sinks: &[i64], costs: &[f64]) -> Vec<(usize, usize, i64)> {
    let mut moves: Vec<_> = cheapest_tree(sources, sinks, costs).arcs().collect();
    moves.retain(|(.., units)| *units > 0);
    moves.sort_unstable();
    moves
}

/// The tree of arcs of an optimal plan, with the prices that prove it.
fn cheapest_tree(sources: &[i64], sinks: &[i64], costs: &[f64]) -> SpanningTree {
    let mut arcs = nearest(costs, sinks.len());
    let mut tree = greedy(sources, sinks, costs, &arcs);
    let largest = costs.iter().fold(0.0, |largest: f64, cost| largest.max(cost.abs()));
    let mut search = Search {
        next: 0,
        tolerance: 64.0 * f64::EPSILON * largest,
        pivots: 0,
        round: ROUND * (sources.len() + sinks.len()),
    };
    let cost = |source: usize, sink: usize| costs[source * sinks.len() + sink];
    loop {
        while let Some((arc, reduced_cost)) = search.entering(&arcs, &tree, sources.len()) {
            tree.pivot(arc.source as usize, arc.sink as usize, reduced_cost);
            search.pivots += 1;
            if search.pivots.is_multiple_of(search.round) {
                tree.reprice(cost);
                search.tolerance *= 2.0;
            }
        }
        tree.reprice(cost);
        let before = arcs.len();
        price_all(&mut arcs, &tree, sources.len(), sinks.len(), costs, search.tolerance);
        if arcs.len() == before {
            return tree;
        }
        search.next = before;
    }
}

struct Search {
    /// Index in the list at which the search continues.
    next: usize,
    /// Reduced costs that are not below the negative of this may be rounding errors and are ignored.
    tolerance: f64,
    pivots: usize,
    round: usize,
}

impl Search {
    /// The arc with the most negative reduced cost in the first block that has one.
    fn entering(&mut self, arcs: &[Arc], tree: &SpanningTree, sources: usize) -> Option<(Arc, f64)> {
        let block = (2.0 * (arcs.len() as f64).sqrt()) as usize + 10;
        let mut left = arcs.len();
        while left > 0 {
            if self.next >= arcs.len() {
                self.next = 0;
            }
            let end = (self.next + block.min(left)).min(arcs.len());
            let (mut least, mut found) = (-self.tolerance, None);
            for arc in &arcs[self.next..end] {
                let reduced = arc.cost - tree.price(arc.source as usize) - tree.price(sources + arc.sink as usize);
                if reduced < least {
                    (least, found) = (reduced, Some(*arc));
                }
            }
            left -= end - self.next;
            self.next = end;
            if let Some(arc) = found {
                return Some((arc, least));
            }
        }
        None
    }
}

/// Adds arcs that would lower the cost to the list: for each source the best one, and those at least half as good.
fn price_all(arcs: &mut Vec<Arc>, tree: &SpanningTree, sources: usize, sinks: usize, costs: &[f64], tolerance: f64) {
    let prices: Vec<f64> = (0..sinks).map(|sink| tree.price(sources + sink)).collect();
    for (source, row) in costs.chunks_exact(sinks).enumerate() {
        let price = tree.price(source);
        let least = cheapest(row, &prices) - price;
        if least < -tolerance {
            let limit = (least / 2.0).min(-tolerance);
            for (sink, (&cost, &at_sink)) in row.iter().zip(&prices).enumerate() {
                if cost - at_sink - price < limit {
                    let (source, sink) = (source as u32, sink as u32);
                    arcs.push(Arc { cost, source, sink });
                }
            }
        }
    }
}

/// The smallest difference between a cost and a price. Four at a time, which the compiler vectorises.
fn cheapest(row: &[f64], prices: &[f64]) -> f64 {
    let mut least = [f64::INFINITY; 4];
    let (rows, prices) = (row.chunks_exact(4), prices.chunks_exact(4));
    let rest = rows.remainder().iter().zip(prices.remainder());
    let rest = rest.fold(f64::INFINITY, |least, (cost, price)| least.min(cost - price));
    for (costs, prices) in rows.zip(prices) {
        for lane in 0..4 {
            let difference = costs[lane] - prices[lane];
            least[lane] = if difference < least[lane] {
                difference
            } else {
                least[lane]
            };
        }
    }
    least.into_iter().fold(rest, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Checks that the marginals match to the unit, and that prices are feasible and equal to the cost wherever something
    /// moves: that proves the optimum.
    fn check(sources: &[i64], sinks: &[i64], costs: &[f64]) -> f64 {
        let tree = cheapest_tree(sources, sinks, costs);
        let sink_prices: Vec<f64> = (0..sinks.len()).map(|sink| tree.price(sources.len() + sink)).collect();
        let (mut sent, mut received) = (vec![0; sources.len()], vec![0; sinks.len()]);
        let scale = costs.iter().fold(1e-300, |largest: f64, cost| largest.max(cost.abs()));
        let rows = costs.chunks(sinks.len());
        let source_prices: Vec<f64> = rows.map(|row| cheapest(row, &sink_prices)).collect();
        let mut total = 0.0;
        for (source, sink, units) in solve(sources, sinks, costs) {
            assert!(units > 0);
            sent[source] += units;
            received[sink] += units;
            let cost = costs[source * sinks.len() + sink];
            total += units as f64 * cost;
            let slack = cost - source_prices[source] - sink_prices[sink];
            assert!(
                slack.abs() <= 1e-11 * scale,
                "an arc that carries flow has slack {slack}"
            );
        }
        assert_eq!((sent.as_slice(), received.as_slice()), (sources, sinks));
        total
    }

    /// Random sides with the same number of units.
    fn sides() -> impl Strategy<Value = (Vec<i64>, Vec<i64>)> {
        let side = || prop::collection::vec(1i64..6, 1..30);
        (side(), side()).prop_map(|(mut a, mut b)| {
            let (of_a, of_b): (i64, i64) = (a.iter().sum(), b.iter().sum());
            a[0] += (of_b - of_a).max(0);
            b[0] += (of_a - of_b).max(0);
            (a, b)
        })
    }

    #[test]
    fn two_by_two_takes_the_short_arcs() {
        assert_eq!(check(&[1, 1], &[1, 1], &[0.0, 5.0, 5.0, 0.0]), 0.0);
        assert_eq!(check(&[3, 1], &[1, 3], &[1.0, 4.0, 2.0, 1.0]), 1.0 + 8.0 + 1.0);
        assert_eq!(check(&[7], &[7], &[2.0]), 14.0);
    }

    #[test]
    fn full_nearest_sinks_do_not_prevent_the_optimum() {
        // Fifty sources in one place: all have the same few candidate sinks.
        let costs: Vec<f64> = (0..50 * 200)
            .map(|k| f64::from(k % 200) + f64::from(k / 200) * 1e-3)
            .collect();
        let total = check(&[4; 50], &[1; 200], &costs);
        let expected = (0..200).map(f64::from).sum::<f64>() + 4.0 * 1e-3 * (0..50).map(f64::from).sum::<f64>();
        assert!((total - expected).abs() < 1e-6, "{total}, expected {expected}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn prices_prove_every_plan_optimal((sources, sinks) in sides(), numbers in prop::collection::vec(0.0f64..1.0, 900)) {
            check(&sources, &sinks, &numbers[..sources.len() * sinks.len()]);
        }

        #[test]
        fn search_with_ties_terminates((sources, sinks) in sides(), numbers in prop::collection::vec(0u8..3, 900)) {
            let costs: Vec<f64> = numbers.into_iter().map(f64::from).collect();
            check(&sources, &sinks, &costs[..sources.len() * sinks.len()]);
        }

        #[test]
        fn unit_masses_are_an_assignment(n in 1usize..30, numbers in prop::collection::vec(-1.0f64..1.0, 900)) {
            check(&vec![1; n], &vec![1; n], &numbers[..n * n]);
        }
    }
}
