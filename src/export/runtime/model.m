function [y, x] = @NAME@(u, parameters)
% @NAME@: outputs along inputs, one sample of @TS@ s per row. Written by `lacuna export`.
%
%   [y, x] = @NAME@(u) simulates from the start. Columns of u: @INPUTS@
%   Columns of y: @OUTPUTS@
%   x holds the states after the last sample.
%
%   @NAME@(u, struct('name', value)) changes parameters:
%   @HELP@
  if nargin < 2
    parameters = struct();
  end
  p = zeros(@NP@, 1);
  @PARAMETERS@
  c = prepare(p);
  x = [@STATES@];
  past.depths = [@DEPTHS@];
  past.values = cell(1, numel(past.depths));
  started = 0;
  samples = size(u, 1);
  y = zeros(samples, @NY@);
  for k = 1:samples
    now = u(k, :);
    later = u(min(k + 1, samples), :);
    t = (k - 1)*@TS@;
    y(k, :) = outputs(p, c, x, past, now, later, t, 0, started);
    for j = 0:@SUBSTEPS@ - 1
      [x, past] = advance(p, c, x, past, now, later, t + j*@H@, j, started);
      started = 1;
    end
  end
end

function c = prepare(p)
  c = zeros(@NC@, 1);
  @PREPARE@
end

function y = outputs(p, c, x, past, u, u_next, t, j, started)
  y = zeros(1, @NY@);
  @OUTPUT@
end

function [x, past] = advance(p, c, x, past, u, u_next, t, j, started)
  next = zeros(@NN@, 1);
  @ADVANCE@
  x = next(1:@NX@);
  for line = 1:numel(past.depths)
    values = [past.values{line}, next(@NX@ + line)];
    past.values{line} = values(max(1, end - past.depths(line) + 1):end);
  end
end

function value = pick(parameters, name, value)
  if isfield(parameters, name)
    value = parameters.(name);
  end
end

function value = choose(a, yes, no)
  if a > 0
    value = yes;
  else
    value = no;
  end
end

function value = smaller(a, b)
  value = choose((b < a) + (b ~= b), b, a);
end

function value = larger(a, b)
  value = choose((b > a) + (b ~= b), b, a);
end

function value = real_sqrt(a)
  value = choose(-a, NaN, sqrt(max(a, 0)));
end

function value = real_log(a)
  value = choose(-a, NaN, log(max(a, 0)));
end

function value = real_asin(a)
  value = choose(abs(a) - 1, NaN, asin(min(max(a, -1), 1)));
end

function value = real_acos(a)
  value = choose(abs(a) - 1, NaN, acos(min(max(a, -1), 1)));
end

function value = real_power(a, b)
  value = a^b;
  if ~isreal(value)
    value = NaN;
  end
end

function value = at_step(past, line, steps, now)
  values = past.values{line};
  back = min(steps, min(numel(values), past.depths(line) - 1));
  if back > 0
    value = values(end - back + 1);
  else
    value = now;
  end
end

function value = past_held(past, line, back, now)
  whole = floor(back);
  part = back - whole;
  newer = at_step(past, line, whole, now);
  older = at_step(past, line, whole + 1, now);
  if part == 0
    value = newer;
  else
    value = (1 - part)*newer + part*older;
  end
end

function value = past_line(past, line, at, now, later)
  if at >= 0
    value = now + at*(later - now);
  else
    whole = floor(-at);
    newer = at_step(past, line, whole, now);
    older = at_step(past, line, whole + 1, now);
    value = newer + (-at - whole)*(older - newer);
  end
end
