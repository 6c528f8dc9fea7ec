// Two rings in a plane, lying beside each other along x. Lengths in m.

DefineConstant[ inner = {0.03, Name "inner"} ];
DefineConstant[ outer = {0.04, Name "outer"} ];
DefineConstant[ gap = {0.002, Name "gap"} ];       // between them
DefineConstant[ facets = {48, Name "facets"} ];    // of a quarter of each circle

For side In {0:1}
  at = (2 * side - 1) * (outer + gap / 2);
  centre = newp;
  Point(centre) = {at, 0, 0};
  For k In {0:3}
    c = Cos(k * Pi / 2);
    s = Sin(k * Pi / 2);
    in[k] = newp;
    Point(in[k]) = {at + inner * c, inner * s, 0};
    out[k] = newp;
    Point(out[k]) = {at + outer * c, outer * s, 0};
  EndFor
  For k In {0:3}
    next = (k + 1) % 4;
    inside[k] = newl;
    Circle(inside[k]) = {in[k], centre, in[next]};
    outside[k] = newl;
    Circle(outside[k]) = {out[k], centre, out[next]};
    Transfinite Curve {inside[k], outside[k]} = facets + 1;
  EndFor
  loop = newll;
  Curve Loop(loop) = {outside[]};
  hole = newll;
  Curve Loop(hole) = {inside[]};
  ring[side] = news;
  Plane Surface(ring[side]) = {loop, hole};
EndFor

Physical Surface("left") = {ring[0]};
Physical Surface("right") = {ring[1]};
