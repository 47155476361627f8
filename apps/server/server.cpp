#include "server/server.h"

#include <fcntl.h>
#include <signal.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>

#include "scene/scene_file.h"
#include "server/hello.h"
#include "server/http_connection.h"
#include "server/temporary_folder.h"
#include "voxlume/error.h"

namespace voxlume::server {

namespace asio = boost::asio;
using boost::system::error_code;
using tcp = asio::ip::tcp;

namespace {

constexpr int kMostConnections = 256;

/// Programs that are started later must not keep a connection open.
void close_on_exec(int descriptor) { ::fcntl(descriptor, F_SETFD, FD_CLOEXEC); }

tcp::acceptor listen(asio::io_context& io, const std::string& address, unsigned short port) {
  error_code failed;
  const auto parsed = asio::ip::make_address(address, failed);
  if (failed)
    throw Error(ErrorCode::kBadParameter, "--bind", "found \"" + address + "\", expected an IP address");
  const tcp::endpoint endpoint(parsed, port);
  tcp::acceptor acceptor(io);
  acceptor.open(endpoint.protocol(), failed);
  if (!failed) close_on_exec(acceptor.native_handle());
  if (!failed) acceptor.set_option(asio::socket_base::reuse_address(true), failed);
  if (!failed) acceptor.bind(endpoint, failed);
  if (!failed) acceptor.listen(asio::socket_base::max_listen_connections, failed);
  if (failed)
    throw Error(ErrorCode::kBadParameter, "--port",
                "cannot listen at " + address + ":" + std::to_string(port) + ": " + failed.message() +
                    "; --port 0 takes any that is free");
  return acceptor;
}

/// Takes connections, as many at a time as there may be.
class Listener {
 public:
  Listener(tcp::acceptor acceptor, ServerParts parts)
      : acceptor_(std::move(acceptor)), retry_(acceptor_.get_executor()), parts_(parts) {}

  void accept() {
    acceptor_.async_accept([this](error_code failed, tcp::socket socket) {
      if (failed == asio::error::operation_aborted) return;
      if (failed) return accept_later();
      close_on_exec(socket.native_handle());
      // One too many is closed without a word.
      if (connections_.use_count() <= kMostConnections)
        std::make_shared<HttpConnection>(boost::beast::tcp_stream(std::move(socket)), parts_, connections_)
            ->read();
      accept();
    });
  }

  void close() {
    error_code ignored;
    acceptor_.close(ignored);
    retry_.cancel(ignored);
  }

 private:
  /// Out of descriptors, say.
  void accept_later() {
    retry_.expires_after(std::chrono::milliseconds(100));
    retry_.async_wait([this](error_code failed) {
      if (!failed) accept();
    });
  }

  tcp::acceptor acceptor_;
  asio::steady_timer retry_;
  const ServerParts parts_;
  const std::shared_ptr<void> connections_ = std::make_shared<int>();  ///< shared by all that are open
};

Roots allowed_roots(const ServerOptions& options, const std::filesystem::path& uploads) {
  Roots roots(options.folder);
  roots.add(uploads);
  if (!options.samples.empty()) roots.add(options.samples);
  for (const Sample& sample : find_samples(options.samples))
    if (sample.path != kPhantomPath) roots.add(sample.path);
  if (options.scene)
    for (const std::string& path : scene_paths(*options.scene)) roots.add(path);
  return roots;
}

bool is_ignored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

std::string url_host(const std::string& address) {
  return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

SharedView::Settings view_settings(const ServerOptions& options, const std::filesystem::path& temporary) {
  return {.live = options.live,
          .samples = find_samples(options.samples),
          .environments = options.samples.empty() ? "" : options.samples / "env",
          .program = options.program,
          .temporary = temporary};
}

}  // namespace

struct Server::Parts {
  Parts(asio::io_context& context, const ServerOptions& options, tcp::acceptor acceptor)
      : io(context),
        port(acceptor.local_endpoint().port()),
        access(make_token(), options.address, port),
        uploads(temporary.path() / "uploads", {.most_bytes = options.most_upload_bytes}),
        view(io, view_settings(options, temporary.path()),
             allowed_roots(options, temporary.path() / "uploads"), uploads),
        routes(view, PageFiles(options.page)),
        listener(std::move(acceptor), {access, view, routes, uploads}) {}

  void say_goodbye() {
    listener.close();
    view.close();
    farewell.expires_after(std::chrono::milliseconds(150));
    farewell.async_wait([this](error_code) { io.stop(); });
  }

  asio::io_context& io;
  TemporaryFolder temporary;
  const unsigned short port;
  const Access access;
  Uploads uploads;
  SharedView view;
  const Routes routes;
  Listener listener;
  asio::signal_set signals{io, SIGINT, SIGTERM};
  asio::steady_timer farewell{io};
};

Server::Server(const ServerOptions& options)
    : io_(std::make_unique<asio::io_context>(1)),
      parts_(std::make_unique<Parts>(*io_, options, listen(*io_, options.address, options.port))) {
  Parts& parts = *parts_;
  if (!is_ignored(SIGHUP)) parts.signals.add(SIGHUP);  // nohup ignores it
  parts.signals.async_wait([&parts](error_code failed, int) {
    if (failed) return;
    parts.signals.clear();  // the next one ends the process
    parts.say_goodbye();
  });
  if (options.scene) {
    SceneDescription scene = *options.scene;
    parts.view.roots().resolve_paths(scene);
    parts.view.open(scene);
  }
  parts.listener.accept();
}

Server::~Server() = default;

std::string Server::url() const {
  const Access& access = parts_->access;
  return "http://" + url_host(access.address()) + ":" + std::to_string(parts_->port) +
         "/?token=" + access.token();
}

void Server::run() {
  io_->run();
  // What is being read now may take a while to end; the files need not wait for it.
  parts_->view.end();
  parts_->temporary.remove();
}

void Server::stop() {
  asio::post(*io_, [this] { parts_->say_goodbye(); });
}

}  // namespace voxlume::server
