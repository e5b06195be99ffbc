#!/bin/sh
# Tunes the learners of the sequence `mixed` in validation worlds, with two seeds per value. Finished runs are not repeated.
#     scripts/tune.sh RESULTS [--jobs N]
set -eu
results=$1; shift
jobs="$*"
one() { # LEARNER NAME=VALUE…
    learner=$1; shift
    for set in "$@"; do
        # shellcheck disable=SC2086
        python -m driftworld benchmark run mixed_tuning --split validation --learner "$learner" --set "$set" --seeds 2 -o "$results" $jobs
    done
}
one finetuning entropy=0.01 entropy=0.03 entropy=0.06
one ewc strength=0.001 strength=0.01 strength=0.1 strength=1
one online_ewc strength=0.001 strength=0.01 strength=0.1 strength=1
one clear policy_cloning=0.003 policy_cloning=0.01 policy_cloning=0.03 policy_cloning=0.1
one l2 strength=0.0001 strength=0.001 strength=0.01 strength=0.1
one packnet retraining=0.08 retraining=0.15 retraining=0.25 retraining=0.4 retraining=0.6
one shrink_and_perturb shrink=0.4 shrink=0.6 shrink=0.8 shrink=0.9
