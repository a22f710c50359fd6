#include "base/two/b.h"
