// Tasks to start from in the author view. Each is valid, and short enough to take in at a glance.

import map from "./templates/map.json";
import maze from "./templates/maze.json";
import park from "./templates/park.json";

/** A name for the list, and the text of the task. */
export interface Template {
  name: string;
  text: string;
}

export const TEMPLATES: Template[] = [
  { name: "a maze, different in every world", text: maze },
  { name: "a map drawn with letters", text: map },
  { name: "a park with things to collect", text: park },
];
