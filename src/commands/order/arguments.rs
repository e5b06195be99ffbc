//! [`OrderArgs`]: the ordering options shared by `order` and `curriculum`.

use std::str::FromStr;

use clap::Args;

use crate::design::DesignOrder;
use crate::ordering::OrderRequest;
use crate::similarity::Method;
use crate::spec::did_you_mean;
use crate::tasks;
use driftworld_text::{WordKind, removed};

/// How an order is found; shared with `curriculum`.
#[derive(Args)]
pub(crate) struct OrderArgs {
    /// Order of the variants [default: the shortest path; exact for up to 15 variants].
    ///
    /// What is to be like what: gradual (the shortest path, with the smallest largest step among equals), outward (by growing
    /// distance from the first), abrupt (the longest path), path (the shortest path), farthest (each time what is farthest
    /// from all before it), named (as given). Or a method: nearest, exact, two-opt, random, target-step, given.
    #[arg(long, value_name = "ORDER")]
    order: Option<OrderWord>,
    /// First variant, such as blue [default: the one named first, or whichever is best of one whole task].
    #[arg(long, value_name = "VARIANT")]
    start: Option<String>,
    /// Last variant [default: whichever is best].
    #[arg(long, value_name = "VARIANT")]
    end: Option<String>,
    /// Step between neighbours for the order target-step.
    #[arg(long, value_name = "DISTANCE")]
    target_step: Option<f64>,
}

/// Values of `--order`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OrderWord {
    /// An order by purpose.
    Design(DesignOrder),
    /// A method.
    Method(Method),
}

impl OrderWord {
    /// The method for it; `None` for the shortest path.
    fn method(self) -> Option<Method> {
        match self {
            Self::Method(method) => Some(method),
            Self::Design(order) => order.method(),
        }
    }
}

impl FromStr for OrderWord {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        if let Some((_, design)) = DesignOrder::WORDS.iter().find(|(name, _)| *name == word) {
            return Ok(Self::Design(*design));
        }
        word.parse().map(Self::Method).map_err(|_| {
            if let Some(advice) = removed(WordKind::Order, word) {
                return advice;
            }
            let designs = DesignOrder::WORDS.map(|(name, _)| name);
            let methods = Method::ALL.iter().map(|method| method.name());
            let methods: Vec<&str> = methods.filter(|name| !designs.contains(name)).collect();
            let near = did_you_mean(word, designs.iter().chain(&methods).copied());
            format!(
                "expected one of {}, or a method: {}{near}",
                designs.join(", "),
                methods.join(", ")
            )
        })
    }
}

impl OrderArgs {
    /// The library's request for a plain order.
    pub(crate) fn request(&self) -> OrderRequest {
        OrderRequest {
            method: self.order.and_then(OrderWord::method),
            start: self.start.as_deref().map(tasks::label_of),
            end: self.end.as_deref().map(tasks::label_of),
            target_step: self.target_step,
        }
    }

    /// The library's request for a design, and separately the order by purpose, if the word names one.
    pub(crate) fn design(&self) -> (OrderRequest, Option<DesignOrder>) {
        let (method, order) = match self.order {
            Some(OrderWord::Method(method)) => (Some(method), None),
            Some(OrderWord::Design(order)) => (None, Some(order)),
            None => (None, None),
        };
        let request = OrderRequest {
            method,
            start: self.start.clone(),
            end: self.end.clone(),
            target_step: self.target_step,
        };
        (request, order)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_word_names_an_order_by_purpose_or_method() {
        assert_eq!("abrupt".parse(), Ok(OrderWord::Design(DesignOrder::Abrupt)));
        assert_eq!("two-opt".parse(), Ok(OrderWord::Method(Method::TwoOpt)));
        for method in Method::ALL {
            assert!(method.name().parse::<OrderWord>().is_ok(), "{}", method.name());
        }
        let refused = "gradul".parse::<OrderWord>().expect_err("there is none");
        assert!(refused.ends_with("did you mean \"gradual\"?"), "{refused}");
    }
}
