//! The typed documents of Driftworld: worlds, task specs, variants, scenarios, and their JSON Schemas.
