"""Tests `driftworld.elements`, which measures the elements that variants change."""

import driftworld
import pytest


def test_variant_with_a_different_reward_changes_only_the_reward():
    found = driftworld.elements("find_objects", "blue", "modest", worlds=2)
    (variant,) = found["variants"]
    assert (found["base"], variant["variant"], variant["verdict"]) == ("blue", "modest", "sound")
    assert [measured["element"] for measured in variant["measured"]] == ["R"]
    assert variant["measured"][0]["witness"]["what"] == "the reward"
    assert variant["proof"]["worlds"] == 2


def test_reward_is_visible_only_with_segmentation():
    def letters(modalities):
        found = driftworld.elements("find_objects", "red", "penalty", modalities=modalities, worlds=2, steps=30)
        return [measured["element"] for measured in found["variants"][0]["measured"]]

    assert letters(["rgb", "depth"]) == ["R"]
    assert letters(["segmentation"]) == ["R", "phi"]


def test_wrong_declaration_is_reported():
    document = {
        "name": "dim",
        "parameters": {"light": {"role": "variant", "type": "number", "affects": ["R"], "range": [0, 4], "default": 2}},
        "world": {"environment_params": {"light_intensity": {"param": "light"}}},
        "variants": {"day": {}, "dusk": {"light": 1}},
    }
    found = driftworld.elements(driftworld.TaskSpec.from_dict(document), worlds=1, steps=5)
    (contradiction,) = found["variants"][0]["contradictions"]
    assert contradiction["element"] == "phi"
    assert "dim#dusk: found that phi (emission) differs from day" in contradiction["message"]


def test_single_variant_is_refused():
    with pytest.raises(TypeError, match="expected none or two"):
        driftworld.elements("find_objects", "blue")
    with pytest.raises(driftworld.TaskError, match="ritch"):
        driftworld.elements("find_objects", "blue", "ritch")
    with pytest.raises(driftworld.TaskError, match="worlds"):
        driftworld.elements("find_objects", "blue", "red", worlds=0)
