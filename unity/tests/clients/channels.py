"""The client's end of L2Explorer's three side channels: sends and receives JSON, and stores every answer."""

from __future__ import annotations

import json
import uuid
from typing import Any

from mlagents_envs.side_channel.side_channel import IncomingMessage, OutgoingMessage, SideChannel

GUIDS = {
    "Reset": "621f0a70-4f87-11ea-a6bf-784f4387d1f7",
    "State": "37715121-3bce-45ff-966d-680586560a5d",
    "Debug": "c5fba0b5-6392-4433-a95f-cdec6b0061e1",
}


class RawChannel(SideChannel):
    """A channel that sends and receives bytes."""

    def __init__(self, guid: str) -> None:
        super().__init__(uuid.UUID(guid))
        #: Received messages, oldest first.
        self.received: list[bytes] = []

    def on_message_received(self, msg: IncomingMessage) -> None:
        self.received.append(bytes(msg.get_raw_bytes()))

    def send_bytes(self, data: bytes) -> None:
        message = OutgoingMessage()
        message.set_raw_bytes(bytearray(data))
        self.queue_message_to_send(message)


class JsonChannel(RawChannel):
    """One of L2Explorer's three channels."""

    def __init__(self, name: str) -> None:
        super().__init__(GUIDS[name])

    def say(self, action: str, payload: Any = None, **extra: Any) -> str:
        """Queues a message for the next reset or step; returns its token."""
        token = str(uuid.uuid4())
        message = {"token": token, "msg_time": "2026-01-02T03:04:05", "action": action, **extra}
        if payload is not None:
            message["payload"] = payload
        self.send_text(json.dumps(message))
        return token

    def send_text(self, text: str) -> None:
        """Queues a string, which may contain non-ASCII characters (the clients' own functions send only ASCII)."""
        data = text.encode()
        self.send_bytes(len(data).to_bytes(4, "little") + data)

    def take(self) -> list[dict[str, Any]]:
        """The messages received since the last call, which must be ASCII for old clients."""
        texts = [data[4:].decode("ascii") for data in self.received]
        self.received = []
        return [json.loads(text) for text in texts]

    def answer(self, token: str) -> dict[str, Any]:
        """The answer to a message, which must be the only one received since the last call."""
        (answer,) = (message for message in self.take() if message["req_token"] == token)
        return dict(answer)


class Channels:
    """The three channels of one client."""

    def __init__(self) -> None:
        self.reset, self.state, self.debug = (JsonChannel(name) for name in GUIDS)

    @property
    def all(self) -> list[JsonChannel]:
        return [self.reset, self.state, self.debug]
