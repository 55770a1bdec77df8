#include "lobelia/app/app.h"

int main(int argc, char** argv) { return lobelia::app::run(argc, argv); }
