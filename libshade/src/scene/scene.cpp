// SPDX-License-Identifier: Apache-2.0
#include "relief/shade/scene.h"
