#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <initializer_list>

#include "cli/commands.h"

namespace {

/// Opens standard streams that the caller has closed: otherwise an opened file could get the number of a standard
/// stream and receive the output. Standard input and error become /dev/null; writing to standard output stays an error.
void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1) {
      const int opened = open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
      if (opened != stream && opened >= 0) dup2(opened, stream), close(opened);
    }
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  // Exceeding the file size limit, and a pipe whose reader is gone, become write errors instead of ending the program.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  return frond::run(argc, argv);
}
