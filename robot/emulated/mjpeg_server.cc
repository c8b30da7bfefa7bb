#include "robot/emulated/mjpeg_server.h"

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "robot/base/error.h"

namespace merlin {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using tcp = asio::ip::tcp;

constexpr char kBoundary[] = "merlinframe";
constexpr std::chrono::milliseconds kPictureLimit(500);

struct Listening {
  int socket;
  int port;
};

Listening ListenOn(int port) {
  try {
    asio::io_context io;
    tcp::acceptor acceptor(io, tcp::endpoint(asio::ip::address_v4::loopback(), static_cast<unsigned short>(port)));
    const int got = acceptor.local_endpoint().port();
    return {acceptor.release(), got};
  } catch (const boost::system::system_error& error) {
    throw MachineError("127.0.0.1:" + std::to_string(port) + ": cannot listen on this port: " + error.code().message());
  }
}

// One part of the stream: its head, the picture, and the boundary that ends it. A reader that waits for the boundary
// therefore has the picture at once.
std::vector<std::uint8_t> Part(const ColorFrame& frame, int quality) {
  const cv::Mat picture(frame.height, frame.width, CV_8UC3, const_cast<std::uint8_t*>(frame.bgr.data()));
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", picture, jpeg, {cv::IMWRITE_JPEG_QUALITY, quality});
  const std::string head = "Content-Type: image/jpeg\r\nContent-Length: " + std::to_string(jpeg.size()) + "\r\n\r\n";
  const std::string end = std::string("\r\n--") + kBoundary + "\r\n";
  std::vector<std::uint8_t> part(head.begin(), head.end());
  part.insert(part.end(), jpeg.begin(), jpeg.end());
  part.insert(part.end(), end.begin(), end.end());
  return part;
}

}  // namespace

MjpegServer::MjpegServer(int port, int quality) : quality_(quality) {
  const Listening listening = ListenOn(port);
  port_ = listening.port;
  url_ = "http://127.0.0.1:" + std::to_string(port_) + "/stream.mjpg";
  server_.emplace(listening.socket, [this](int socket) { Serve(socket); });
}

MjpegServer::~MjpegServer() { frames_.Close(); }

void MjpegServer::Serve(int socket) {
  asio::io_context io;
  tcp::socket stream(io, tcp::v4(), socket);
  boost::system::error_code error;
  boost::beast::flat_buffer buffer(16384);  // the longest request head
  http::request<http::empty_body> request;
  http::read(stream, buffer, request, error);
  if (!error) {
    stream.set_option(tcp::no_delay(true), error);
    http::response<http::empty_body> head{http::status::ok, 11};
    head.set(http::field::content_type, std::string("multipart/x-mixed-replace; boundary=") + kBoundary);
    head.set(http::field::cache_control, "no-store");
    http::response_serializer<http::empty_body> serializer(head);
    http::write_header(stream, serializer, error);
    asio::write(stream, asio::buffer(std::string("--") + kBoundary + "\r\n"), error);
  }
  for (std::uint64_t seen = frames_.count(); !error && !frames_.closed();) {
    const auto frame = frames_.WaitAfter(seen, kPictureLimit);
    seen = frame.number;
    if (frame.item != nullptr) asio::write(stream, asio::buffer(Part(*frame.item, quality_)), error);
  }
  stream.release(error);  // the caller closes the socket
}

}  // namespace merlin
