// What the numbers of each measure mean, in a sentence; docs/similarity.md has the definitions.

const UNITS: Record<string, string> = {
  parameters: "1 is one parameter moved over its whole range. A parameter that counts for several elements counts once in the total.",
  worlds: "Every part has a unit of its own, such as 10 m, half a turn, 100 points or black for white.",
  pictures: "1 is black for white, on objects or around them; 2 is the most.",
  "pictures:whole": "1 is black for white everywhere.",
  "pictures:structure": "0 is the same edges and textures, 1 the opposite ones.",
  occupancy: "In metres: how far objects would have to move on average, summed over their classes.",
  "occupancy:jaccard": "1 is no place in common.",
  "occupancy:hausdorff": "In metres: how far the farthest taken place is from any of the other.",
  "occupancy:chamfer": "In metres: how far taken places are from the nearest of the other, on average.",
  placements: "1 is 10 m on average, or a class of objects that one of the two lacks; classes are summed.",
  objects: "In metres: how far objects are from those of the other, on average; an object without a counterpart counts 10 m.",
  "objects:counts": "1 is no object with a counterpart.",
  colors: "1 is as far apart as two colours can be, for every object.",
  rewards: "0 asks for the same, about 0.7 for something unrelated, 1 for the reverse.",
  dynamics: "1 is 100 points, 10 m or half a turn of difference after the same action, on average.",
  "dynamics:bisimulation": "1 is 100 points of difference for each action, if both do the same.",
  behavior: "1 is 100 points an episode that the planner of the one earns less in worlds of the other than their own planner.",
  "behavior:success": "1 is a planner that always succeeds in its own worlds, and never in those of the other.",
};

/** The unit of a measure; one after a colon has that of the whole family, if it has none of its own. */
export const unitOf = (by: string): string => UNITS[by] ?? UNITS[by.split(":")[0]!] ?? "";
