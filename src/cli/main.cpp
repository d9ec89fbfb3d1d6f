#include <csignal>

#include "cli/commands.h"

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding the file size limit becomes a write error instead of ending the program
  return frond::run(argc, argv);
}
