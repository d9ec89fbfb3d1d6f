#include <csignal>

#include "cli/commands.h"

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows past its limit is a message, not the end
  return frond::run(argc, argv);
}
