//! [`Drift`]: the variants between one variant and another.

use driftworld_spec::{Domain, DriftSchedule, DriftSwitch, RegimeDrift, Value, Variant};

use crate::GeneratorError;
use crate::interpolation::interpolate;
use crate::stream::Stream;

/// How values that cannot be interpolated change: strings, booleans, numbers from a list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Switch {
    /// At the fraction that the parameter declares as `switch_at`, or halfway if it declares none.
    #[default]
    AtPoint,
    /// At random: at fraction t of the drift, a world has the new value with probability t, drawn with this seed.
    Mixture {
        /// The seed.
        seed: u64,
    },
    /// One coin toss for the whole variant: at fraction t of the drift, a world belongs to the second variant with probability
    /// t, drawn with this seed, otherwise to the first. Nothing is interpolated, not even numbers; the variants may belong to
    /// different tasks.
    Task {
        /// The seed.
        seed: u64,
    },
}

/// A path from one variant to another of the same task, or of any other task if whole variants [switch](Switch::Task).
///
/// Numbers, points, vectors and the numbers of distributions of one family are interpolated linearly; headings turn the shorter
/// way round, or through their range; colours, including those of distributions, are interpolated in Oklab, so that they change
/// evenly to the eye; distributions of different families are mixed where possible; layouts change as described at
/// [`Layout::toward`](driftworld_spec::Layout::toward); everything else switches. At 0 and 1, the result is the given variant.
///
/// # Example
/// ```
/// use driftworld_generator::Drift;
/// use driftworld_spec::TaskSpec;
/// let task = TaskSpec::from_json("t", r#"{ "name": "t", "parameters": {
///     "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0, 4], "default": 0 } },
///     "variants": { "night": {}, "day": { "light": 2 } } }"#)?;
/// let drift = Drift::new(task.variant("night")?, task.variant("day")?)?;
/// assert_eq!(drift.at(0.25, 0)?.value("light").and_then(|light| light.as_number()), Some(0.5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Drift {
    from: Variant,
    to: Variant,
    schedule: DriftSchedule,
    switch: Switch,
}

/// The variant at fraction `t`, 0..=1, between two variants of one task: a linear [`Drift`] with [`Switch::AtPoint`].
///
/// # Errors
/// As [`Drift::new`] and [`Drift::at`].
pub fn drift(from: &Variant, to: &Variant, t: f64) -> Result<Variant, GeneratorError> {
    Drift::new(from.clone(), to.clone())?.at(t, 0)
}

impl Drift {
    /// A linear drift between two variants of the same task, with [`Switch::AtPoint`].
    ///
    /// # Errors
    /// [`GeneratorError::DifferentTasks`].
    pub fn new(from: Variant, to: Variant) -> Result<Self, GeneratorError> {
        if from.task().name() == to.task().name() {
            Ok(Self {
                from,
                to,
                schedule: DriftSchedule::default(),
                switch: Switch::default(),
            })
        } else {
            Err(GeneratorError::DifferentTasks {
                from: from.id(),
                to: to.id(),
            })
        }
    }

    /// A drift between two variants of any tasks, in which each world belongs to one of the two: to the second with a
    /// probability equal to the drift's progress, drawn with a seed.
    ///
    /// # Example
    /// ```
    /// use driftworld_generator::Drift;
    /// use driftworld_spec::TaskSpec;
    /// let task = |name: &str| TaskSpec::from_json(name, &format!(r#"{{ "name": "{name}" }}"#));
    /// let (a, b) = (task("a")?.variant("default")?, task("b")?.variant("default")?);
    /// let drift = Drift::mixing(a, b, 7);
    /// let of_b = (0..1000).filter(|index| drift.at(0.3, *index).is_ok_and(|variant| variant.id() == "b#default"));
    /// assert!((250..350).contains(&of_b.count()));
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn mixing(from: Variant, to: Variant, seed: u64) -> Self {
        Self {
            from,
            to,
            schedule: DriftSchedule::default(),
            switch: Switch::Task { seed },
        }
    }

    /// The drift declared by a scenario's regime, from the regime's variant to the drift's end variant; random switches use the
    /// regime's seed.
    ///
    /// # Errors
    /// [`GeneratorError::DifferentTasks`].
    pub fn declared(drift: &RegimeDrift, from: Variant, to: Variant, seed: u64) -> Result<Self, GeneratorError> {
        let switch = match drift.switch {
            DriftSwitch::AtPoint => Switch::AtPoint,
            DriftSwitch::Mixture => Switch::Mixture { seed },
            DriftSwitch::Task => return Ok(Self::mixing(from, to, seed).with_schedule(drift.schedule)),
        };
        Ok(Self::new(from, to)?.with_schedule(drift.schedule).with_switch(switch))
    }

    /// Uses a different schedule.
    #[must_use]
    pub fn with_schedule(mut self, schedule: DriftSchedule) -> Self {
        self.schedule = schedule;
        self
    }

    /// Uses a different way of switching.
    #[must_use]
    pub fn with_switch(mut self, switch: Switch) -> Self {
        self.switch = switch;
        self
    }

    /// The variant at `progress`, 0..=1, for world number `index`, which only random switches use.
    ///
    /// # Errors
    /// [`GeneratorError::Between`] if a variant in between violates a requirement or is invalid;
    /// [`GeneratorError::DifferentTasks`] for two tasks without whole-variant switches.
    pub fn at(&self, progress: f64, index: u64) -> Result<Variant, GeneratorError> {
        let t = self.schedule.at(progress);
        if t == 0.0 {
            return Ok(self.from.clone());
        }
        if t == 1.0 {
            return Ok(self.to.clone());
        }
        if let Switch::Task { seed } = self.switch {
            let coin = Stream::new(self.from.task().name(), seed, "drift")
                .at(index, 0, 0)
                .unit();
            return Ok(if coin < t { self.to.clone() } else { self.from.clone() });
        }
        if self.from.task().name() != self.to.task().name() {
            return Err(GeneratorError::DifferentTasks {
                from: self.from.id(),
                to: self.to.id(),
            });
        }
        let changes = self.from.values().iter().filter_map(|(name, from)| {
            let to = self.to.value(name)?;
            (from != to).then(|| (name.clone(), self.between(name, from, to, t, index)))
        });
        let name = format!("{}..{}@{}", self.from.name(), self.to.name(), (t * 1e6).round() / 1e6);
        self.from.with(&name, changes).map_err(GeneratorError::Between)
    }

    fn between(&self, name: &str, from: &Value, to: &Value, t: f64, index: u64) -> Value {
        let parameter = &self.from.task().parameters()[name];
        let listed = matches!(parameter.domain(), Some(Domain::Choices(_)));
        interpolate(parameter, listed, from, to, t, (&self.from, &self.to)).unwrap_or_else(|| {
            let threshold = match self.switch {
                Switch::AtPoint | Switch::Task { .. } => parameter.switch_at.unwrap_or(0.5),
                Switch::Mixture { seed } => Stream::new(self.from.task().name(), seed, &format!("drift/{name}"))
                    .at(index, 0, 0)
                    .unit(),
            };
            if t >= threshold { to.clone() } else { from.clone() }
        })
    }
}
