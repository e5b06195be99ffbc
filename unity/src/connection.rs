//! [`Connection`]: one client's gRPC server, called again and again. What is said is decided in `session/mod.rs`.

use std::time::Duration;

use tokio::time::{Instant, sleep, timeout, timeout_at};
use tonic::client::Grpc;
use tonic::codegen::http::uri::PathAndQuery;
use tonic::transport::{Channel, Endpoint};
use tonic::{Code, Request, Response, Status};
use tonic_prost::ProstCodec;

use crate::error::UnityError;
use crate::protocol::UnityMessageProto;

/// The longest message that is read, in bytes: far more than the texts of the channels may hold in values.
pub const MAX_INCOMING_BYTES: usize = 48 << 20;

/// How long a connection may be silent before the network is asked whether there is somebody still.
const KEEPALIVE: Duration = Duration::from_secs(30);

/// How long to wait before looking again for a client that is not there yet.
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// The protocol's one call: Python is the server, the world is the client. Each call carries what the world has to say, and is
/// answered by what it is to do next.
const CALL: &str = "/communicator_objects.UnityToExternalProto/Exchange";

/// A client, found.
pub(crate) struct Connection {
    client: Grpc<Channel>,
    address: String,
}

/// What comes of a call.
pub(crate) enum Reply {
    /// The client's next message.
    Message(Box<UnityMessageProto>),
    /// It is gone, with what the network says.
    Gone(String),
}

impl Connection {
    /// Looks for a client for so long.
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
            // Another machine may lose its power without a word.
            .tcp_keepalive(Some(KEEPALIVE));
        loop {
            match timeout_at(deadline, endpoint.connect()).await {
                Ok(Ok(channel)) => {
                    let client = Grpc::new(channel).max_decoding_message_size(MAX_INCOMING_BYTES);
                    return Ok(Self { client, address });
                }
                Ok(Err(_)) if Instant::now() + BETWEEN_LOOKS < deadline => sleep(BETWEEN_LOOKS).await,
                _ => {
                    let seconds = wait.as_secs_f64();
                    return Err(UnityError::NoClient { address, seconds });
                }
            }
        }
    }

    /// Machine and port.
    pub(crate) fn address(&self) -> &str {
        &self.address
    }

    /// The first call, by which a stranger is known: whoever listens there has as long again to answer as a client does.
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

    /// Says something, and waits for the answer: as long as the client likes.
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
        // Our reading of a message failed: it is too long, or no protobuf.
        Err(status)
            if matches!(status.code(), Code::OutOfRange | Code::Internal | Code::DataLoss)
                && !is_transport(&status) =>
        {
            Err(UnityError::Unreadable(status.message().to_owned()))
        }
        // A client that closes cancels the call, one that is killed breaks the connection, and one that ends within its handler
        // says that this failed: all of them are gone.
        Err(status) => Ok(Reply::Gone(reason(&status))),
    }
}

/// Whether the network failed rather than somebody answered.
fn is_transport(status: &Status) -> bool {
    std::error::Error::source(status).is_some()
}

/// A status in words, with the innermost cause.
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
