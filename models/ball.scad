// One ball: the smallest scene there is.
color("tomato") sphere(r = 10, $fn = 64);
