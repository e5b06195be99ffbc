//! [`Connection`]: calls a client's gRPC server.

use std::time::Duration;

use tokio::time::{Instant, sleep, timeout, timeout_at};
use tonic::client::Grpc;
use tonic::codegen::http::uri::PathAndQuery;
use tonic::transport::{Channel, Endpoint};
use tonic::{Code, Request, Response, Status};
use tonic_prost::ProstCodec;

use crate::error::UnityError;
use crate::protocol::UnityMessageProto;

/// Maximum length of an incoming message, in bytes: far more than any message within the limits on strings and values needs.
pub const MAX_INCOMING_BYTES: usize = 48 << 20;

/// Time of silence after which TCP checks whether the other side is still there.
const KEEPALIVE: Duration = Duration::from_secs(30);

/// Interval between attempts to reach a client.
const RETRY_INTERVAL: Duration = Duration::from_millis(50);

/// The protocol's only call. Python is the server, and the world is the client: each call carries the world's output, and the
/// response is the next input.
const CALL: &str = "/communicator_objects.UnityToExternalProto/Exchange";

/// A connection to a client.
pub(crate) struct Connection {
    client: Grpc<Channel>,
    address: String,
}

/// The result of a call.
pub(crate) enum Reply {
    /// The client's next message.
    Message(Box<UnityMessageProto>),
    /// The client is gone; the network's message says why.
    Gone(String),
}

impl Connection {
    /// Tries to connect to a client for at most `wait`.
    pub(crate) async fn open(host: &str, port: u16, wait: Duration) -> Result<Self, UnityError> {
        let deadline = Instant::now() + wait;
        let host = if host.contains(':') {
            format!("[{host}]")
        } else {
            host.to_owned()
        };
        let address = format!("{host}:{port}");
        let no_address = |_| UnityError::NoAddress(address.clone());
        let endpoint = Endpoint::from_shared(format!("http://{address}"))
            .map_err(no_address)?
            .tcp_nodelay(true)
            // Detects a machine that has lost power.
            .tcp_keepalive(Some(KEEPALIVE));
        loop {
            match timeout_at(deadline, endpoint.connect()).await {
                Ok(Ok(channel)) => {
                    let client = Grpc::new(channel).max_decoding_message_size(MAX_INCOMING_BYTES);
                    return Ok(Self { client, address });
                }
                Ok(Err(_)) if Instant::now() + RETRY_INTERVAL < deadline => sleep(RETRY_INTERVAL).await,
                _ => {
                    let seconds = wait.as_secs_f64();
                    return Err(UnityError::NoClient { address, seconds });
                }
            }
        }
    }

    /// Host and port.
    pub(crate) fn address(&self) -> &str {
        &self.address
    }

    /// Makes the first call, which detects servers that are not clients: a client has to answer within `wait`.
    pub(crate) async fn greet(&mut self, greeting: UnityMessageProto, wait: Duration) -> Result<Reply, UnityError> {
        let address = self.address.clone();
        match timeout(wait, self.call(greeting)).await {
            Err(_) => {
                let reason = format!("silence for {} s", wait.as_secs_f64());
                Err(UnityError::NotAClient { address, reason })
            }
            Ok(Err(status)) if status.code() == Code::Unimplemented || is_transport(&status) => {
                let reason = reason(&status);
                Err(UnityError::NotAClient { address, reason })
            }
            Ok(answer) => reply(answer),
        }
    }

    /// Sends a message and waits for the answer without a time limit.
    pub(crate) async fn exchange(&mut self, message: UnityMessageProto) -> Result<Reply, UnityError> {
        reply(self.call(message).await)
    }

    async fn call(&mut self, message: UnityMessageProto) -> Result<UnityMessageProto, Status> {
        let ready = self.client.ready().await;
        ready.map_err(|error| Status::unknown(format!("Service was not ready: {error}")))?;
        let (path, codec) = (PathAndQuery::from_static(CALL), ProstCodec::default());
        let answer = self.client.unary(Request::new(message), path, codec).await;
        answer.map(Response::into_inner)
    }
}

fn reply(answer: Result<UnityMessageProto, Status>) -> Result<Reply, UnityError> {
    match answer {
        Ok(message) => Ok(Reply::Message(Box::new(message))),
        // The message could not be decoded: it is too long, or not valid protobuf.
        Err(status)
            if matches!(status.code(), Code::OutOfRange | Code::Internal | Code::DataLoss)
                && !is_transport(&status) =>
        {
            Err(UnityError::Unreadable(status.message().to_owned()))
        }
        // A client that closes cancels the call, one that is killed breaks the connection, and one that exits within its handler
        // reports a failure. In each case the client is gone.
        Err(status) => Ok(Reply::Gone(reason(&status))),
    }
}

/// Whether the network failed, rather than the server returning an error.
fn is_transport(status: &Status) -> bool {
    std::error::Error::source(status).is_some()
}

/// A status as text: its innermost cause if there is one, otherwise its code and message.
fn reason(status: &Status) -> String {
    let mut cause: &dyn std::error::Error = status;
    while let Some(inner) = cause.source() {
        cause = inner;
    }
    if std::ptr::addr_eq(cause, status) {
        format!("{:?}: {}", status.code(), status.message())
    } else {
        cause.to_string()
    }
}
