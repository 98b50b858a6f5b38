// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "carus/report/site.hpp"

namespace carus::report {

/// HTTP/1.1 for a Site: GET and HEAD, nothing else. One thread; a connection that says nothing for 30 s is closed. On a
/// loopback address only requests to a loopback name are answered, so that no page from elsewhere can read it under a
/// name of its own.
class Server {
 public:
  /// `port` 0 takes a free one. Throws InputError if the address is none, or is taken.
  Server(Site& site, const std::string& address, unsigned short port);
  ~Server();
  [[nodiscard]] unsigned short port() const;
  /// Until stop(), or with `on_signals` SIGINT or SIGTERM.
  void run(bool on_signals = false);
  void stop();  ///< from any thread

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace carus::report
