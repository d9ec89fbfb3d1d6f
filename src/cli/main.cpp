#include "cli/commands.h"

int main(int argc, char** argv) { return frond::run(argc, argv); }
