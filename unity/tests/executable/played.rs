//! [`Client`]: simulates a Python client (a gRPC server) at the byte level, so that it can also send invalid messages.

use std::convert::Infallible;
use std::net::TcpListener;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll};
use std::thread::JoinHandle;
use std::time::Duration;

use driftworld_unity::protocol::{
    CommandProto, HeaderProto, UnityInputProto, UnityMessageProto, UnityRlInitializationInputProto, UnityRlInputProto,
};
use prost::Message;
use prost::bytes::{Buf, BufMut};
use tokio::sync::oneshot;
use tonic::codec::{Codec, DecodeBuf, Decoder, EncodeBuf, Encoder};
use tonic::codegen::{BoxFuture, Service, http};
use tonic::server::{Grpc, NamedService, UnaryService};
use tonic::transport::Server;
use tonic::transport::server::TcpIncoming;
use tonic::{Request, Response, Status};

/// A client's reaction to a call.
#[derive(Clone, Debug)]
pub(crate) enum Answer {
    Bytes(Vec<u8>),
    Fail(Status),
}

impl From<UnityMessageProto> for Answer {
    fn from(message: UnityMessageProto) -> Self {
        Self::Bytes(message.encode_to_vec())
    }
}

/// A client that answers calls in order, and stays silent when it has no answers left.
pub(crate) struct Client {
    pub(crate) port: u16,
    calls: Receiver<Vec<u8>>,
    leave: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Client {
    /// A client on a free port.
    pub(crate) fn new(answers: impl IntoIterator<Item = Answer>) -> Self {
        Self::listening(free_port(), answers)
    }

    /// A client on this listener.
    pub(crate) fn listening(listener: TcpListener, answers: impl IntoIterator<Item = Answer>) -> Self {
        Self::serving(listener, answers, Played::new)
    }

    /// A client on a free port with a different service.
    pub(crate) fn of_another_kind() -> Self {
        Self::serving(free_port(), [], |answers, calls| Stranger(Played::new(answers, calls)))
    }

    fn serving<S>(
        listener: TcpListener,
        answers: impl IntoIterator<Item = Answer>,
        service: impl FnOnce(Vec<Answer>, Sender<Vec<u8>>) -> S,
    ) -> Self
    where
        S: Service<http::Request<tonic::body::Body>, Response = http::Response<tonic::body::Body>, Error = Infallible>
            + NamedService
            + Clone
            + Send
            + Sync
            + 'static,
        S::Future: Send + 'static,
    {
        let port = listener.local_addr().expect("the listener is bound").port();
        let (sender, calls) = channel();
        let (leave, left) = oneshot::channel();
        let service = service(answers.into_iter().collect(), sender);
        let thread = std::thread::spawn(move || {
            let runtime = tokio::runtime::Builder::new_current_thread()
                .enable_all()
                .build()
                .expect("the runtime can be created");
            runtime.block_on(async {
                listener
                    .set_nonblocking(true)
                    .expect("the listener can be made non-blocking");
                let listener = tokio::net::TcpListener::from_std(listener).expect("the listener is bound");
                let serving = Server::builder()
                    .add_service(service)
                    .serve_with_incoming(TcpIncoming::from(listener));
                tokio::select! {
                    ended = serving => ended.expect("the server runs without errors"),
                    _ = left => {}
                }
            });
            // Dropping the runtime closes all connections.
        });
        Self {
            port,
            calls,
            leave: Some(leave),
            thread: Some(thread),
        }
    }

    /// Waits for the next call.
    pub(crate) fn call(&self) -> UnityMessageProto {
        let bytes = self
            .calls
            .recv_timeout(Duration::from_mins(1))
            .expect("the executable makes a call");
        UnityMessageProto::decode(bytes.as_slice()).expect("every call carries a valid message")
    }

    /// All calls since the last query.
    pub(crate) fn calls(&self) -> Vec<UnityMessageProto> {
        let calls = self.calls.try_iter();
        calls
            .map(|bytes| UnityMessageProto::decode(bytes.as_slice()).expect("every call carries a valid message"))
            .collect()
    }

    /// Disconnects, even during a call.
    pub(crate) fn leave(&mut self) {
        // The client may already have left.
        let _ = self.leave.take().map(|leave| leave.send(()));
        if let Some(thread) = self.thread.take() {
            thread.join().expect("the client does not panic");
        }
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        let _ = self.leave.take().map(|leave| leave.send(()));
    }
}

/// Binds a free port.
pub(crate) fn free_port() -> TcpListener {
    TcpListener::bind("127.0.0.1:0").expect("the machine has a free port")
}

fn input(status: i32, input: Option<UnityInputProto>) -> UnityMessageProto {
    let message = "words".to_owned();
    UnityMessageProto {
        header: Some(HeaderProto { status, message }),
        unity_input: input,
        unity_output: None,
    }
}

/// The first message of a client with this version of the protocol.
pub(crate) fn who(communication_version: &str) -> Answer {
    let who = UnityRlInitializationInputProto {
        communication_version: communication_version.to_owned(),
        package_version: "0.16.0".to_owned(),
        ..UnityRlInitializationInputProto::default()
    };
    let input_message = UnityInputProto {
        rl_initialization_input: Some(who),
        rl_input: None,
    };
    input(200, Some(input_message)).into()
}

pub(crate) fn says(rl_input: UnityRlInputProto) -> Answer {
    let input_message = UnityInputProto {
        rl_input: Some(rl_input),
        rl_initialization_input: None,
    };
    input(200, Some(input_message)).into()
}

pub(crate) fn command(command: CommandProto) -> Answer {
    says(UnityRlInputProto {
        command: command.into(),
        ..UnityRlInputProto::default()
    })
}

/// A message with only a status.
pub(crate) fn status(status: i32) -> Answer {
    input(status, None).into()
}

/// The gRPC service of a client.
#[derive(Clone)]
struct Played {
    answers: Arc<Mutex<std::vec::IntoIter<Answer>>>,
    calls: Sender<Vec<u8>>,
}

impl Played {
    fn new(answers: Vec<Answer>, calls: Sender<Vec<u8>>) -> Self {
        let answers = Arc::new(Mutex::new(answers.into_iter()));
        Self { answers, calls }
    }
}

impl NamedService for Played {
    const NAME: &'static str = "communicator_objects.UnityToExternalProto";
}

impl Service<http::Request<tonic::body::Body>> for Played {
    type Response = http::Response<tonic::body::Body>;
    type Error = Infallible;
    type Future = BoxFuture<Self::Response, Self::Error>;

    fn poll_ready(&mut self, _: &mut Context<'_>) -> Poll<Result<(), Infallible>> {
        Poll::Ready(Ok(()))
    }

    fn call(&mut self, request: http::Request<tonic::body::Body>) -> Self::Future {
        assert_eq!(
            request.uri().path(),
            "/communicator_objects.UnityToExternalProto/Exchange"
        );
        let played = self.clone();
        Box::pin(async move { Ok(Grpc::new(Raw).unary(played, request).await) })
    }
}

impl UnaryService<Vec<u8>> for Played {
    type Response = Vec<u8>;
    type Future = BoxFuture<Response<Vec<u8>>, Status>;

    fn call(&mut self, request: Request<Vec<u8>>) -> Self::Future {
        // The test may have dropped the other end.
        let _ = self.calls.send(request.into_inner());
        let answer = self
            .answers
            .lock()
            .expect("no thread panics while it holds the lock")
            .next();
        Box::pin(async move {
            match answer {
                Some(Answer::Bytes(bytes)) => Ok(Response::new(bytes)),
                Some(Answer::Fail(status)) => Err(status),
                None => std::future::pending().await,
            }
        })
    }
}

/// An unknown service.
#[derive(Clone)]
struct Stranger(Played);

impl NamedService for Stranger {
    const NAME: &'static str = "weather.Forecast";
}

impl Service<http::Request<tonic::body::Body>> for Stranger {
    type Response = http::Response<tonic::body::Body>;
    type Error = Infallible;
    type Future = BoxFuture<Self::Response, Self::Error>;

    fn poll_ready(&mut self, context: &mut Context<'_>) -> Poll<Result<(), Infallible>> {
        self.0.poll_ready(context)
    }

    fn call(&mut self, request: http::Request<tonic::body::Body>) -> Self::Future {
        Service::call(&mut self.0, request)
    }
}

/// Passes messages through as bytes.
struct Raw;

impl Codec for Raw {
    type Encode = Vec<u8>;
    type Decode = Vec<u8>;
    type Encoder = Self;
    type Decoder = Self;

    fn encoder(&mut self) -> Self {
        Self
    }

    fn decoder(&mut self) -> Self {
        Self
    }
}

impl Encoder for Raw {
    type Item = Vec<u8>;
    type Error = Status;

    fn encode(&mut self, item: Vec<u8>, bytes: &mut EncodeBuf<'_>) -> Result<(), Status> {
        bytes.put_slice(&item);
        Ok(())
    }
}

impl Decoder for Raw {
    type Item = Vec<u8>;
    type Error = Status;

    fn decode(&mut self, bytes: &mut DecodeBuf<'_>) -> Result<Option<Vec<u8>>, Status> {
        let length = bytes.remaining();
        Ok(Some(bytes.copy_to_bytes(length).to_vec()))
    }
}
