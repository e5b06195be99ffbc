//! Processes numbered items on several threads and delivers the results in the order of the numbers.

use std::collections::BTreeMap;
use std::ops::{ControlFlow, Range};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Maximum number of undelivered items per thread: bounds the number of waiting results.
const AHEAD: usize = 16;

/// Processes every item of a range, one worker per thread, and delivers the results in order; ends early if `deliver` returns
/// `Break`.
///
/// Items are started in order, each by a free worker. After an early end, items in progress are finished and dropped. If `work`
/// panics, the panic resumes here when the item's result would be delivered; after an early end, it is dropped, too. If the
/// system cannot start all threads, the work is done by fewer, or by the calling thread alone.
pub(super) fn in_order<W: Send, T: Send, E>(
    items: Range<u64>,
    workers: Vec<W>,
    work: impl Fn(&mut W, u64) -> T + Sync,
    mut deliver: impl FnMut(u64, T) -> Result<ControlFlow<()>, E>,
) -> Result<ControlFlow<()>, E> {
    let (num_workers, ahead) = (workers.len(), AHEAD * workers.len());
    // Handed out one by one: if a thread cannot be started, its worker remains available.
    let workers = Mutex::new(workers);
    let next_worker = || workers.lock().unwrap_or_else(PoisonError::into_inner).pop();
    let (sender, receiver) = mpsc::channel();
    let receiver = Mutex::new(receiver);
    let next_item = || receiver.lock().unwrap_or_else(PoisonError::into_inner).recv();
    thread::scope(|scope| {
        // Dropped on every exit, so that no thread keeps waiting for an item.
        let sender = sender;
        let (results, arrived) = mpsc::channel();
        let start_thread = |_: &usize| {
            let (results, work, next_worker, next_item) = (results.clone(), &work, &next_worker, &next_item);
            let thread = thread::Builder::new().spawn_scoped(scope, move || {
                let Some(mut worker) = next_worker() else { return };
                while let Ok(item) = next_item() {
                    // The results of a worker that panicked are never used: the panic is delivered before them.
                    let result = catch_unwind(AssertUnwindSafe(|| work(&mut worker, item)));
                    if results.send((item, result)).is_err() {
                        break;
                    }
                }
            });
            thread.is_ok()
        };
        if (0..num_workers).take_while(start_thread).count() == 0 {
            return process_in_this_thread(items, next_worker(), &work, &mut deliver);
        }
        let mut later = items.clone();
        let mut send_items = |count: usize| {
            let sent = later.by_ref().take(count).try_for_each(|item| sender.send(item));
            sent.expect("the receiver outlives the threads");
        };
        send_items(ahead);
        let mut waiting = BTreeMap::new();
        for wanted in items {
            let result = loop {
                if let Some(result) = waiting.remove(&wanted) {
                    break result;
                }
                let (item, result) = arrived.recv().expect("a thread returns a result for every item");
                waiting.insert(item, result);
            };
            if deliver(wanted, result.unwrap_or_else(|panic| resume_unwind(panic)))?.is_break() {
                return Ok(ControlFlow::Break(()));
            }
            send_items(1);
        }
        Ok(ControlFlow::Continue(()))
    })
}

/// Processes every item in this thread.
fn process_in_this_thread<W, T, E>(
    items: Range<u64>,
    worker: Option<W>,
    work: &impl Fn(&mut W, u64) -> T,
    deliver: &mut impl FnMut(u64, T) -> Result<ControlFlow<()>, E>,
) -> Result<ControlFlow<()>, E> {
    let Some(mut worker) = worker else {
        return Ok(ControlFlow::Continue(()));
    };
    for item in items {
        if deliver(item, work(&mut worker, item))?.is_break() {
            return Ok(ControlFlow::Break(()));
        }
    }
    Ok(ControlFlow::Continue(()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How the processing ended.
    type End = Result<ControlFlow<()>, String>;

    /// Squares 10..200; even items take longer than odd ones. Returns the results up to `last`, and how it ended.
    fn squares(jobs: usize, last: u64) -> (Vec<(u64, u64)>, End) {
        let mut taken = Vec::new();
        let work = |(): &mut (), item: u64| {
            let turns = if item.is_multiple_of(2) { 20_000 } else { 1 };
            (0..turns).fold(0_u64, |sum, turn| sum.wrapping_add(std::hint::black_box(turn)));
            item * item
        };
        let end = in_order(10..200, vec![(); jobs], work, |item, square| {
            taken.push((item, square));
            match item {
                150 if last == 150 => Err("stopped".to_owned()),
                _ if item == last => Ok(ControlFlow::Break(())),
                _ => Ok(ControlFlow::Continue(())),
            }
        });
        (taken, end)
    }

    #[test]
    fn results_come_in_order_for_any_number_of_threads() {
        let expected: Vec<(u64, u64)> = (10..200).map(|item| (item, item * item)).collect();
        for jobs in [1, 2, 7, 64] {
            assert_eq!(squares(jobs, 200), (expected.clone(), Ok(ControlFlow::Continue(()))));
        }
    }

    #[test]
    fn early_ends_and_errors_leave_no_thread_waiting() {
        for jobs in [1, 3] {
            let (taken, end) = squares(jobs, 20);
            assert_eq!((taken.len(), end), (11, Ok(ControlFlow::Break(()))));
            let (taken, end) = squares(jobs, 150);
            assert_eq!((taken.len(), end), (141, Err("stopped".to_owned())));
        }
    }

    #[test]
    fn panicking_worker_leaves_no_thread_waiting() {
        for jobs in [1, 2, 8] {
            let (done, ended) = mpsc::channel();
            thread::spawn(move || {
                let work = |(): &mut (), item: u64| {
                    assert_ne!(item, 3, "this one is too hard");
                    item
                };
                let mut taken = Vec::new();
                let all = || {
                    in_order(0..10_000, vec![(); jobs], work, |item, _| {
                        taken.push(item);
                        Ok::<_, ()>(ControlFlow::Continue(()))
                    })
                };
                let panic = catch_unwind(AssertUnwindSafe(all)).expect_err("item 3 panics");
                let is_expected = panic
                    .downcast_ref::<String>()
                    .is_some_and(|text| text.contains("too hard"));
                done.send((taken, is_expected))
            });
            let ended = ended.recv_timeout(std::time::Duration::from_mins(1));
            assert_eq!(ended, Ok((vec![0, 1, 2], true)), "{jobs} threads: the panic ends it");
        }
    }

    #[test]
    fn single_thread_gives_the_same_results() {
        let mut taken = Vec::new();
        let work = |(): &mut (), item: u64| item * item;
        let end: End = process_in_this_thread(10..15, Some(()), &work, &mut |item, square| {
            taken.push((item, square));
            Ok(if item == 13 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            })
        });
        assert_eq!(
            (taken, end),
            (
                (10..14).map(|item| (item, item * item)).collect(),
                Ok(ControlFlow::Break(()))
            )
        );
    }

    #[test]
    fn empty_range_does_nothing() {
        let end: Result<_, ()> = in_order(5..5, vec![(); 2], |(), item| item, |_, _| Ok(ControlFlow::Continue(())));
        assert_eq!(end, Ok(ControlFlow::Continue(())));
    }
}
