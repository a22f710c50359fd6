#include "scenario/s.h"
