"""Records the messages that a published Python client sends, byte for byte and in order.

    python record.py EXECUTABLE > client_0.16.json

runs the executable with that Python's mlagents-envs, and writes one line per message: a description, and its bytes on
the wire, in hexadecimal. `conversation.rs` replays them to a session. Each file names the versions that recorded it.
"""

import json
import sys
import uuid

import google.protobuf
import mlagents_envs
import mlagents_envs.rpc_communicator as rpc
import numpy as np
from mlagents_envs.environment import UnityEnvironment
from mlagents_envs.side_channel.engine_configuration_channel import EngineConfigurationChannel
from mlagents_envs.side_channel.environment_parameters_channel import EnvironmentParametersChannel
from mlagents_envs.side_channel.float_properties_channel import FloatPropertiesChannel
from mlagents_envs.side_channel.outgoing_message import OutgoingMessage
from mlagents_envs.side_channel.side_channel import SideChannel

try:
    from mlagents_envs.base_env import ActionTuple
except ImportError:  # Clients before 0.23 take the array itself.
    ActionTuple = None

RESET = "621f0a70-4f87-11ea-a6bf-784f4387d1f7"
STATE = "37715121-3bce-45ff-966d-680586560a5d"
DEBUG = "c5fba0b5-6392-4433-a95f-cdec6b0061e1"

WORLD = {
    "game_mode": "learn",
    "max_steps": 8,
    "environment_params": {"light_intensity": "3.5", "predefined_map": "0", "map_size": [60, 60]},
    "agent_params": {
        "action_model": "byvelocity",
        "agent_height": 1.0,
        "agent_width": 1.0,
        "observation_size": 24,
        "coordinates": [0, 0],
        "heading": 0,
    },
    "objects": [
        {
            "class": "cube",
            "model": "1",
            "coordinates": [0, 1.5],
            "color": [0, 0, 255],
            "reward": 2.5,
            "reward_stimulus": ["AgentCollide"],
            "destroy_stimulus": ["AgentCollide"],
            "unique_name": "near",
        },
        {"class": "tree", "model": "3", "coordinates": [5, 12], "color": [0, 0.5, 0]},
    ],
}

recorded = []
about = "the client's identity"


class Recorder(rpc.UnityToExternalServicerImplementation):
    """Records outgoing messages."""

    def Exchange(self, request, context):
        reply = super().Exchange(request, context)
        recorded.append({"about": about, "hex": reply.SerializeToString(deterministic=True).hex()})
        return reply


class Json(SideChannel):
    """One of L2Explorer's channels."""

    def __init__(self, channel):
        super().__init__(uuid.UUID(channel))
        self.received = []

    def on_message_received(self, message):
        self.received.append(message.read_string())

    def say(self, number, **fields):
        message = OutgoingMessage()
        token = f"00000000-0000-4000-8000-{number:012}"
        # The original client sends the time without a time zone.
        fields = {"token": token, "msg_time": "2026-01-01T12:00:00.000001", **fields}
        message.write_string(json.dumps(fields))
        super().queue_message_to_send(message)


def main(executable):
    """Runs the conversation and prints the messages."""
    global about
    rpc.UnityToExternalServicerImplementation = Recorder
    worlds, states, debug = Json(RESET), Json(STATE), Json(DEBUG)
    engine, parameters, floats = EngineConfigurationChannel(), EnvironmentParametersChannel(), FloatPropertiesChannel()
    channels = [worlds, states, debug, engine, parameters, floats]
    env = UnityEnvironment(executable, worker_id=77, seed=7, side_channels=channels)

    def step(what, action):
        global about
        about = what
        numbers = np.array([action], dtype=np.float32)
        env.set_actions(behavior, ActionTuple(continuous=numbers) if ActionTuple else numbers)
        env.step()

    about = "a reset, with the engine's configuration, a parameter, a property, and a world"
    engine.set_configuration_parameters(width=84, height=84, quality_level=5, time_scale=20.0, target_frame_rate=60)
    parameters.set_float_parameter("light_intensity", 2.0)
    floats.set_property("gravity", 9.8)
    worlds.say(1, action="reset_environment", payload=WORLD)
    env.reset()
    behavior = (env.get_behavior_names() if hasattr(env, "get_behavior_names") else list(env.behavior_specs))[0]

    step("a step forward", [5, 0, 0])
    step("a step forward, to the right", [5, 45, 0])
    worlds.say(2, action="object_create", unique_name="late", payload={"class": "rock", "coordinates": [-3, 6]})
    step("a step, with a new object", [5, -45, 0])
    states.say(3, action="get_observers")
    states.say(4, action="set_active_observers", payload={"state": ["agent_params", "game_mode"]})
    debug.say(5, action="set_debug_categories", payload=[{"category": "academy", "active": True}])
    step("a step, with requests for the state", [0, 90, 1])
    debug.say(6, action="save_screenshot", payload={"filename": "/tmp/view.png", "upscale_factor": 2})
    step("a step, with a screenshot", [0, 0, 0])
    worlds.say(7, action="object_destroy", payload={})
    worlds.say(8, action="object_create", payload={"class": "rock", "coordinates": [1000, 6], "name": "Bär"})
    step("a step, with an unknown action and an object outside the world", [20, 400, 0])
    step("the last step but one", [0, 0, 0])
    step("the last step", [0, 0, 0])
    step("the first step of the next episode", [5, 0, 0])
    about = "a reset without a world"
    env.reset()
    about = "the end"
    env.close()
    versions = (
        f"mlagents-envs {mlagents_envs.__version__}, protobuf {google.protobuf.__version__}, numpy {np.__version__}, "
        f"Python {sys.version.split()[0]}"
    )
    lines = ",\n".join("    " + json.dumps(message) for message in recorded)
    print(f'{{\n  "made_by": {json.dumps("record.py with " + versions)},\n  "messages": [\n{lines}\n  ]\n}}')


if __name__ == "__main__":
    main(sys.argv[1])
