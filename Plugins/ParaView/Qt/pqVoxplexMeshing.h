// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   pqVoxplexMeshing
 * @brief   what the plugin adds to ParaView's window besides filters
 *
 * - Abort: until version 6.0 ParaView shows the button beside its progress bar only while it saves animations, and the button
 *   reaches no filter. While a filter of the plugin executes in ParaView's own process, this shows the
 *   button, handles its events, and stops the filter when the button is pressed. With a
 *   remote server that is not possible: the client then waits for the server.
 * - Nothing but the button: what else Qt has to do while that filter executes would run inside it. Timers and
 *   pictures of render views wait for its end; input to the rest of the window is lost.
 * - Names and colours of labels: when a filter of the plugin has made a mesh, or when a source has data that carries them, the colour maps of the arrays
 *   `Label` and `Labels` get them (vtkSMLabelColorsProxy). This happens once for each table of labels, so that what the user
 *   changes in a colour map stays.
 * - The first mesh of a filter is brought into view if it is alone there, without its legend if that has more than 30 names.
 * - After an abort the messages say why there is no mesh.
 */
#ifndef pqVoxplexMeshing_h
#define pqVoxplexMeshing_h

#include "vtkPVLabelInformation.h"

#include <QList>
#include <QObject>
#include <QPair>
#include <QPointer>

class pqPipelineSource;

class pqVoxplexMeshing : public QObject
{
  Q_OBJECT

public:
  explicit pqVoxplexMeshing(QObject* parent = nullptr);
  ~pqVoxplexMeshing() override = default;

  void startup();
  void shutdown();

  /** Of the application, while a filter executes. */
  bool eventFilter(QObject* object, QEvent* event) override;

private Q_SLOTS:
  void onProgress(const QString& message, int percent);
  void onProgressEnd();
  void onAbort();
  void onDataUpdated(pqPipelineSource* source);

private:
  Q_DISABLE_COPY(pqVoxplexMeshing)

  using Waiting =
    QPair<QPointer<QObject>, int>; ///< an object and its timer, or 0: a widget and its picture

  bool HandlesButton = false; ///< ParaView leaves the button to this
  bool Executes = false;
  bool HandlesEvents = false;
  bool WereUnblocked = false; ///< what the progress manager did with input before
  QList<Waiting> Postponed;
  vtkPVLabelInformation::LabelMap Applied; ///< the table of labels that the colour maps got last
};

#endif
