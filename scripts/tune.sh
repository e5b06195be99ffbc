#!/bin/sh
# Tunes the learners of the sequence `mixed` in validation worlds; what is finished is not run again.
#     scripts/tune.sh RESULTS
set -eu
one() { # LEARNER NAME=VALUE…
    learner=$1; shift
    for set in "$@"; do
        python -m driftworld benchmark run mixed_tuning --split validation --learner "$learner" --set "$set" -o "$results"
    done
}
results=$1
one finetuning entropy=0.01 entropy=0.03 entropy=0.06
one ewc strength=0.1 strength=1 strength=10 strength=100
one clear policy_cloning=0.03 policy_cloning=0.1 policy_cloning=0.3
one l2 strength=0.01 strength=0.1 strength=1
one packnet retraining=0.15 retraining=0.25 retraining=0.4
one shrink_and_perturb shrink=0.6 shrink=0.8
one online_ewc strength=1 strength=10 strength=100
