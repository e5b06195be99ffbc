// Tasks to begin with in the author view. Each is valid, and small enough to be read at once.

/** A name for the list, and the text of the task. */
export interface Template {
  name: string;
  text: string;
}

const MAZE = `{
  "version": 2,
  "name": "my_maze",
  "description": "Find the gold goal in a maze. Variants change its size, its loops and the light.",
  "parameters": {
    "cells": { "role": "variant", "type": "vector", "affects": ["S", "T", "phi"], "description": "Columns and rows.", "range": [3, 12], "default": [6, 6] },
    "loops": { "role": "variant", "type": "number", "affects": ["S", "T", "phi"], "description": "Share of dead ends that are open.", "range": [0, 1], "default": 0.2 },
    "goal_color": { "role": "variant", "type": "color", "affects": ["O"], "choices": ["gold", "deepskyblue"], "default": "gold" },
    "goal_reward": { "role": "variant", "type": "number", "affects": ["R"], "range": [10, 200], "default": 100 },
    "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0.2, 4], "default": 2.3 }
  },
  "world": {
    "max_seconds": 120,
    "environment_params": {
      "looks": { "style": "natural", "ground": "cobbles", "walls": "stone" },
      "light_intensity": { "param": "light" },
      "layout": { "maze": { "cells": { "param": "cells" }, "cell": 3, "braid": { "param": "loops" } } }
    },
    "agent_params": { "agent_width": 0.8, "max_linear_speed": 6, "coordinates": { "cells": {} }, "heading": { "uniform": { "low": 0, "high": 360 } } },
    "rules": { "reward_per_second": -0.5, "success": [{ "touch": "goal" }] }
  },
  "groups": [
    {
      "name": "goal", "count": 1,
      "object": { "class": "geometric", "model": "3", "color": { "param": "goal_color" }, "reward": { "param": "goal_reward" }, "reward_once_stimulus": ["AgentCollide"] },
      "placement": { "cells": { "walk": [6, 1000] } }
    }
  ],
  "variants": {
    "plain": { "description": "Six by six cells." },
    "wide": { "description": "Nine by nine cells with many loops.", "cells": [9, 9], "loops": 0.8 },
    "dusk": { "description": "In dim light.", "light": 0.6 }
  }
}
`;

const LETTERS = `{
  "version": 2,
  "name": "my_map",
  "description": "Find the green ball on a map drawn by hand.",
  "parameters": {
    "ball_color": { "role": "variant", "type": "color", "affects": ["O"], "choices": ["limegreen", "red"], "default": "limegreen" },
    "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0.2, 4], "default": 2.3 }
  },
  "world": {
    "max_seconds": 90,
    "environment_params": {
      "looks": "natural",
      "light_intensity": { "param": "light" },
      "layout": {
        "text": [
          "###########",
          "#....#....#",
          "#.##.#.##.#",
          "#.#.....#.#",
          "#...#.#...#",
          "###.#.#.###",
          "#...#.#..G#",
          "#.#.....#.#",
          "#A#..#..#.#",
          "###########"
        ],
        "cell": 2, "legend": { "G": { "group": "ball" } }
      }
    },
    "agent_params": { "agent_width": 0.8, "max_linear_speed": 6, "heading": { "uniform": { "low": 0, "high": 360 } } },
    "rules": { "reward_per_second": -0.5, "success": [{ "touch": "ball" }] }
  },
  "groups": [
    {
      "name": "ball", "count": 1,
      "object": { "class": "geometric", "model": "2", "color": { "param": "ball_color" }, "reward": 100, "reward_once_stimulus": ["AgentCollide"] }
    }
  ],
  "variants": { "day": {}, "dusk": { "light": 0.6 }, "red": { "ball_color": "red" } }
}
`;

const PARK = `{
  "version": 2,
  "name": "my_park",
  "description": "Collect what pays in a walled park, past rocks that stand where they were put.",
  "parameters": {
    "prize_color": { "role": "variant", "type": "color", "affects": ["O"], "choices": ["gold", "red", "blue"], "default": "gold" },
    "prize_reward": { "role": "variant", "type": "number", "affects": ["R"], "range": [-100, 100], "default": 100 },
    "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0.2, 4], "default": 2.3 },
    "prizes": { "role": "fixed", "type": "integer", "value": 4 }
  },
  "world": {
    "max_seconds": 60,
    "environment_params": { "looks": "natural", "map_size": [40, 40], "light_intensity": { "param": "light" } },
    "agent_params": { "coordinates": [0, 0], "heading": { "uniform": { "low": 0, "high": 360 } } },
    "rules": { "reward_per_second": -1, "success": ["all_collected"] }
  },
  "groups": [
    {
      "name": "rocks", "count": 3,
      "object": { "class": "rock", "model": "1" },
      "placement": { "points": { "values": [[8, 8], [-9, 4], [3, -10]] } }
    },
    {
      "name": "prizes", "count": { "param": "prizes" },
      "object": {
        "class": "geometric", "model": "1", "color": { "param": "prize_color" }, "reward": { "param": "prize_reward" },
        "reward_once_stimulus": ["AgentCollide"], "destroy_stimulus": ["AgentCollide"]
      },
      "placement": { "box": { "low": [-18, -18], "high": [18, 18] } }, "separation": 2, "keep_out": { "agent": 4 }
    }
  ],
  "variants": { "plain": {}, "red": { "prize_color": "red" }, "dusk": { "light": 0.6 } }
}
`;

export const TEMPLATES: Template[] = [
  { name: "a maze, another in every world", text: MAZE },
  { name: "a map drawn with letters", text: LETTERS },
  { name: "a park with things to collect", text: PARK },
];
