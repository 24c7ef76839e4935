/// What connections over TCP have in common, whichever end is this program's.
#pragma once

#include <string>

#include "wire/transport/tcp.hpp"

namespace skyloop {

/// "127.0.0.1:2000", "[::1]:2000".
std::string shown_address(const TcpAddress& address);

/// A system that does not know the option goes without it.
void set_socket_option(int socket, int level, int name, int value);

/// Options of a connection: small writes leave at once, and an other end that has vanished is given up after a minute.
void prepare_connection(int socket);

/// Whether both ends are this one. A port that is free and of the system's own choice may be called from the very same
/// port: then the two ends are one (RFC 9293, section 3.5, simultaneous open), and no server could ever have the port.
bool calls_itself(int socket);

}  // namespace skyloop
